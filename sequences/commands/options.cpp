// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/options.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <tuple>
#include <utility>

#include <glm/trigonometric.hpp>
#include "regulator/budget.h"
#include "sequences/commands/ineffective.h"
#include "sequences/commands/missing_effects.h"
#include "sequences/commands/words.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/value_type.h"
#include "sequences/files/terminal_text.h"
#include "sequences/pipeline/accumulate.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/predictive/plan_buffers.h"

namespace talisman::sequences {

namespace {

constexpr int kLargestDisplay_px = 16384;
constexpr int kMostThreads = 1024;

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "A<separator>B"; empty unless both are whole numbers.
std::optional<std::pair<int, int>> two_numbers(const std::string& text, char separator) {
  const std::size_t at = text.find(separator, 1);
  if (at == std::string::npos) return std::nullopt;
  const auto a = whole_number(std::string_view(text).substr(0, at));
  const auto b = whole_number(std::string_view(text).substr(at + 1));
  if (!a || !b) return std::nullopt;
  return std::pair{*a, *b};
}

layers::ivec2 display_from(const std::string& text) {
  const auto size = two_numbers(text, 'x');
  if (!size || size->first < 1 || size->second < 1 || size->first > kLargestDisplay_px ||
      size->second > kLargestDisplay_px)
    throw InputError("--size is '" + text + "', must be WxH with both from 1 to " +
                     std::to_string(kLargestDisplay_px));
  return {size->first, size->second};
}

std::pair<int, int> frame_range_from(const std::string& text, int frames) {
  const std::optional<int> single = whole_number(text);
  const auto range =
      single ? std::pair{*single, *single} : two_numbers(text, '-').value_or(std::pair{-1, -1});
  if (range.first < 0 || range.second < range.first || range.second >= frames)
    throw InputError("--frames is '" + text +
                     "', must be A-B with 0 <= A <= B <= " + std::to_string(frames - 1));
  return range;
}

/// "RENDER" or "RENDER,WARP".
void apply_latency(const std::string& text, regulator::LatencyOptions& latency) {
  if (text.empty()) return;
  const std::size_t comma = text.find(',');
  const auto number = [&](std::string_view part) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value))
      throw InputError("--latency-ms is '" + text + "', must be RENDER or RENDER,WARP in milliseconds");
    return value;
  };
  latency.render_ms = number(std::string_view(text).substr(0, comma));
  latency.warp_ms = comma == std::string::npos ? regulator::kNoLastWarp_ms
                                               : number(std::string_view(text).substr(comma + 1));
  if (const std::string defect = first_defect(latency); !defect.empty())
    throw InputError("--latency-ms is '" + text + "': " + defect);
}

/// Only Lookahead looks at frames that it could be wrong about (the oracle is a floor because it knows them), and only a
/// late run at a camera.
void apply_prediction(const CommandLine& line, regulator::RegulatorOptions& options) {
  if (line.predict.empty()) return;
  const regulator::Prediction prediction = choice("--predict", line.predict, kPredictionWords);
  const bool looks_ahead =
      options.policy == regulator::Policy::Lookahead || options.policy == regulator::Policy::Predictive;
  const bool is_late = options.latency.render_ms > 0;
  if (prediction != regulator::Prediction::Known && !looks_ahead && !is_late)
    throw InputError("--predict is '" + line.predict + "', but --policy is '" +
                     std::string(regulator::name(options.policy)) +
                     "', must be lookahead or predictive, or come with --latency-ms above 0");
  if (looks_ahead) options.lookahead.predict = prediction;
  if (is_late) options.latency.predict = prediction;
}

void apply_limits(const CommandLine& line, regulator::RegulatorOptions& options) {
  if (line.budget_polygons) options.budget.polygons = *line.budget_polygons;
  if (line.budget_pixels) options.budget.pixels = *line.budget_pixels;
  if (line.budget_chunks) options.budget.chunks = *line.budget_chunks;
  if (line.budget_ms) options.budget.ms = *line.budget_ms;
  if (line.min_resolution) options.budget.min_resolution = *line.min_resolution;
  if (line.cutoff_px) options.budget.cutoff_px = *line.cutoff_px;
  if (!line.choice.empty()) options.budget.choice = choice("--choice", line.choice, kChoiceRuleWords);
  if (line.depth_complexity) options.budget.depth_complexity = *line.depth_complexity;
}

void apply_thresholds(const CommandLine& line, regulator::RegulatorOptions& options) {
  if (line.geometric_px) options.thresholds.geometric_px = *line.geometric_px;
  if (line.photometric) options.thresholds.photometric = *line.photometric;
  if (line.light_angle_deg) options.thresholds.light_angle_rad = glm::radians(*line.light_angle_deg);
  if (line.turned_px) options.thresholds.turned_px = *line.turned_px;
  if (line.shadow_map_px) options.thresholds.shadow_map_px = *line.shadow_map_px;
  if (!line.color_warp.empty()) options.color_warp = choice("--color-warp", line.color_warp, kSwitchWords);
}

void apply_regrouping(const CommandLine& line, regulator::RegroupOptions& options) {
  if (!line.regroup.empty()) options.by = choice("--regroup", line.regroup, kRegroupWords);
  if (!line.regroup_prices.empty())
    options.prices = choice("--regroup-prices", line.regroup_prices, kRegroupPricesWords);
  if (line.regroup_ceiling_ms) options.ceiling_ms = *line.regroup_ceiling_ms;
  if (line.regroup_dwell) options.dwell_frames = *line.regroup_dwell;
}

/// A budget of time chooses levels by policy budget: where no policy is named, that is meant.
void apply_levels(const CommandLine& line, regulator::RegulatorOptions& options) {
  regulator::LodOptions& lod = options.lod;
  if (!line.lod.empty()) lod.by = choice("--lod", line.lod, kLodWords);
  if (!line.lod.empty() && line.policy.empty() && lod.by == regulator::LodSelector::Optimise)
    options.policy = regulator::Policy::Budget;
  if (!line.lod_benefit.empty()) lod.benefit = choice("--benefit", line.lod_benefit, kLodBenefitWords);
  if (!line.first_appearance.empty())
    lod.first_appearance = choice("--first-appearance", line.first_appearance, kFirstAppearanceWords);
  if (line.px_per_polygon) lod.px_per_polygon = *line.px_per_polygon;
  if (line.feedback_gain) lod.feedback_gain = *line.feedback_gain;
}

/// What each selector needs.
void require_levels(const CommandLine& line, const regulator::RegulatorOptions& options) {
  using enum regulator::LodSelector;
  const regulator::LodSelector by = options.lod.by;
  const std::string is = "--lod is '" + std::string(regulator::name(by)) + "'";
  if (!line.lod.empty() && by != None && !regulator::chooses_levels(options))
    throw InputError(is + ", but --policy is '" + std::string(regulator::name(options.policy)) +
                     "', must be " + (by == Optimise ? "budget" : "reference, threshold or budget"));
  if (!regulator::chooses_levels(options) || (by != Optimise && by != Feedback)) return;
  if (options.budget.ms == regulator::kNoLimitMs) throw InputError(is + ", must come with --budget-ms");
  if (by == Optimise &&
      (options.budget.polygons != regulator::kNoLimit || options.budget.pixels != regulator::kNoLimit ||
       options.budget.chunks != regulator::kNoLimit))
    throw InputError(is + ", must have a budget of --budget-ms alone");
}

/// What holds only of all options together.
void require_consistent(const CommandLine& line, const regulator::RegulatorOptions& options) {
  if (options.policy == regulator::Policy::Budget && !regulator::is_limited(options))
    throw InputError(
        "--policy is 'budget', must come with --budget-polygons, --budget-pixels, --budget-chunks or "
        "--budget-ms");
  if (line.budget_gap && options.policy != regulator::Policy::Budget)
    throw InputError("--budget-gap compares choices within a budget, but --policy is '" +
                     std::string(regulator::name(options.policy)) + "', must be budget");
  if (const std::string defect = regulator::first_defect(options); !defect.empty()) throw InputError(defect);
  require_levels(line, options);
  if (const std::string foreign = of_another_policy(line, options.policy, options.latency.render_ms > 0);
      !foreign.empty())
    throw InputError(foreign);
}

void apply_regulator(const CommandLine& line, regulator::RegulatorOptions& options) {
  if (!line.policy.empty()) options.policy = choice("--policy", line.policy, kPolicyWords);
  apply_thresholds(line, options);
  if (line.hold) options.hold_frames = *line.hold;
  if (line.blend) options.blend_frames = *line.blend;
  if (!line.stagger.empty()) options.stagger = choice("--stagger", line.stagger, kSwitchWords);
  if (line.lookahead) options.lookahead.frames = *line.lookahead;
  if (line.tree_k) options.predictive.children = *line.tree_k;
  if (!line.joining.empty()) options.predictive.joining = choice("--joining", line.joining, kJoiningWords);
  if (!line.motion_norm.empty())
    options.predictive.norm = choice("--motion-norm", line.motion_norm, kMotionNormWords);
  if (!line.intervals.empty())
    options.predictive.intervals = choice("--intervals", line.intervals, kIntervalsWords);
  if (!line.adaptive.empty()) options.predictive.adaptive = choice("--adaptive", line.adaptive, kSwitchWords);
  apply_regrouping(line, options.regroup);
  if (!line.refresh.empty()) options.refresh = choice("--refresh", line.refresh, kRefreshWords);
  apply_levels(line, options);
  apply_limits(line, options);
  apply_latency(line.latency_ms, options.latency);
  apply_prediction(line, options);
  require_consistent(line, options);
}

/// Not so small that what is divided by it is infinite either.
double positive(const char* option, double value, double largest) {
  if (!(value >= kLeast && value <= largest))
    throw InputError(std::string(option) + " is " + shown(value) + ", must be above 0, from " +
                     shown(kLeast) + " to " + shown(largest));
  return value;
}

/// Sprites are compressed where the sequence or the command line asks for it, and there are sprites.
std::optional<chunker::CompressionOptions> compression_from(const CommandLine& line, const Sequence& sequence,
                                                            regulator::Policy policy) {
  const bool has_sprites = policy != regulator::Policy::Direct && policy != regulator::Policy::Predictive;
  if (!line.compression) return has_sprites ? sequence.compression : std::nullopt;
  const int quality = *line.compression;
  if (quality < 0 || quality > 100)
    throw InputError("--compression is " + std::to_string(quality) +
                     ", must be a quality from 1 to 100, or 0 for none");
  if (quality == 0) return std::nullopt;
  if (!has_sprites)
    throw InputError("--compression needs sprites, but --policy is " + std::string(regulator::name(policy)));
  return chunker::CompressionOptions{quality};
}

/// The word of an option where it was given, else what the sequence says.
template <typename T, std::size_t N>
T chosen(const char* option, const std::string& text, const Words<T, N>& words, T otherwise) {
  return text.empty() ? otherwise : choice(option, text, words);
}

/// What is looked at and drawn at all. What the sequence says yields to a policy that cannot do it; an option does not.
void apply_visibility(const CommandLine& line, const Sequence& sequence, Settings& settings) {
  if (!line.visibility.empty()) {
    const std::optional<VisibilityOptions> asked = visibility_from(line.visibility);
    if (!asked) throw InputError("--visibility is '" + line.visibility + "', must be " + kVisibilityRule);
    settings.visibility = *asked;
  }
  const std::string is = "visibility is " + text_of(settings.visibility);
  if (settings.visibility.needs_cells() && !settings.cells)
    throw InputError(is + ", rule: only none,none,frustum without `cells`", sequence.file);
  for (const layers::Layer& layer : sequence.layers.layers)
    if (settings.visibility.needs_cells() && !layer.fade.values.empty())
      throw InputError(is + ", but layer '" + layer.name +
                           "' fades, rule: cells hide nothing behind what can be seen through",
                       sequence.file);
  const regulator::Policy policy = settings.regulator.policy;
  if (!settings.visibility.any() || allows_culling(policy)) return;
  if (!line.visibility.empty())
    throw InputError(is + ", but the policy is " + std::string(regulator::name(policy)) +
                     ", must be direct, reference, threshold or budget");
  settings.visibility = {};
}

/// How layers are bounded, ordered and put together.
void apply_order(const CommandLine& line, const Sequence& sequence, Settings& settings) {
  settings.bound = chosen("--bound", line.bound, kBoundWords, sequence.bound);
  settings.material_points = line.material_points.value_or(sequence.material_points);
  if (settings.material_points < 0 || settings.material_points > layers::kMostMaterialPoints)
    throw InputError("--material-points is " + std::to_string(settings.material_points) +
                     ", must be from 0 to " + std::to_string(layers::kMostMaterialPoints));
  settings.cycles = chosen("--cycles", line.cycles, kCyclesWords, sequence.cycles);
  settings.compositor = chosen("--compositor", line.compositor, kCompositorWords, sequence.compositor);
  settings.late_chunks = chosen("--late-chunks", line.late_chunks, kSwitchWords, settings.late_chunks);
  apply_visibility(line, sequence, settings);
  if (settings.compositor == Compositor::Extended) return;
  for (const layers::Layer& layer : sequence.layers.layers)
    if (layer.shadows_as && layers::needs_registers(*layer.shadows_as))
      throw InputError(sequence.file + ": layer '" + layer.name + "': shadows as " +
                       (layer.shadows_as == layers::ShadowsAs::Multiply ? "multiply" : "atop") +
                       ", rule: only with compositor extended");
}

int samples_from(int samples) {
  if (samples != 1 && samples != 4 && samples != 16)
    throw InputError("--samples is " + std::to_string(samples) + ", must be 1, 4 or 16");
  return samples;
}

/// How large, how dense and how shaded sprites are.
void apply_sprites(const CommandLine& line, const Sequence& sequence, Settings& settings) {
  if (line.expected_reuse)
    settings.extents.expected_reuse_frames = positive("--expected-reuse", *line.expected_reuse, 1e4);
  if (line.resolution) settings.placement.resolution_scale = positive("--resolution", *line.resolution, 4);
  settings.render.shading = chosen("--shading", line.shading, kShadingWords, settings.render.shading);
  if (line.samples) settings.render.samples = samples_from(*line.samples);
  settings.compression = compression_from(line, sequence, settings.regulator.policy);
  if (settings.compression && regulator::blends(settings.regulator))
    throw InputError("blend_frames is " + std::to_string(settings.regulator.blend_frames) +
                     ", but sprites are compressed, must be 0: what is mixed cannot be kept compressed");
}

int accumulated_from(int pictures, regulator::Policy policy) {
  if (pictures < 1 || pictures > kMostAccumulated)
    throw InputError("--accumulate is " + std::to_string(pictures) + ", must be 1 to " +
                     std::to_string(kMostAccumulated));
  if (pictures > 1 && policy != regulator::Policy::Direct && policy != regulator::Policy::Predictive)
    throw InputError("--accumulate is " + std::to_string(pictures) +
                     ", must be 1 unless --policy is direct or predictive, but that is '" +
                     std::string(regulator::name(policy)) + "'");
  return pictures;
}

Settings settings_of(const CommandLine& line, const Sequence& sequence) {
  Settings settings = own_settings(sequence);
  apply_regulator(line, settings.regulator);
  settings.layers_own_warps = line.warp.empty();
  settings.curve = choice("--warp", line.warp.empty() ? sequence.warp : line.warp, kCurveWords);
  if (!line.size.empty()) settings.view.display_px = display_from(line.size);
  apply_order(line, sequence, settings);
  apply_sprites(line, sequence, settings);
  settings.budget_gap = line.budget_gap;
  if (line.accumulate) settings.accumulate = accumulated_from(*line.accumulate, settings.regulator.policy);
  return settings;
}

RunOptions run_options_of(const CommandLine& line, const Sequence& sequence, bool plan_only) {
  RunOptions options;
  options.plan_only = plan_only;
  const char* suffix = plan_only ? "-plan" : line.audit_alone ? "-audit" : "";
  options.out = !line.out.empty() ? line.out : "out/" + sequence.name + suffix;
  options.first_frame = 0;
  options.last_frame = sequence.frames - 1;
  if (!line.frames.empty())
    std::tie(options.first_frame, options.last_frame) = frame_range_from(line.frames, sequence.frames);
  options.format = choice("--format", line.format, kFormatWords);
  options.progress = choice("--progress", line.progress, kProgressWords);
  if (line.quiet) options.progress = ProgressKind::None;
  options.video = line.video;
  options.separate = line.separate;
  options.overlay = line.overlay;
  options.quality = line.quality;
  options.resume = line.resume;
  options.force = line.force;
  options.decisions = choice("--decisions", line.decisions, kDecisionLinesWords);
  options.audit_every = line.audit.value_or(0);
  if (line.audit && *line.audit < 1)
    throw InputError("--audit is " + std::to_string(*line.audit) +
                     ", must be at least 1: every so many reuses");
  if (options.audit_every > 0 && options.resume)
    throw InputError("--audit looks at frames as they are drawn, must be given without --resume");
  if (options.video && options.format == FrameFormat::None)
    throw InputError("--video needs frames, but --format is none");
  if (options.overlay && options.format != FrameFormat::Png)
    throw InputError("--overlay is drawn on png frames, but --format is " + line.format);
  require_threads(line.threads);
  return options;
}

}  // namespace

void require_threads(int threads) {
  if (threads < 0 || threads > kMostThreads)
    throw InputError("--threads is " + std::to_string(threads) +
                     ", must be at least 0 (0: all cores), and at most " + std::to_string(kMostThreads));
}

ContentOptions content_options(const ContentWords& words) {
  constexpr double kLargest = 1e9;
  ContentOptions options;
  std::error_code error;
  if (!words.assets.empty() && !std::filesystem::is_directory(words.assets, error))
    throw InputError("--assets is '" + words.assets + "', must be a folder that is there");
  if (!words.assets.empty()) options.assets.push_back(words.assets);
  if (words.exposure) options.exposure_lx = positive("--exposure", *words.exposure, kLargest);
  if (words.turntable) options.turntable_s = positive("--turntable", *words.turntable, kLargest);
  options.stage = !words.no_stage;
  if (!words.seam.empty()) options.seam = choice("--seam", words.seam, kSeamWords);
  return options;
}

ContentOptions content_options(const CommandLine& line) {
  ContentOptions options = content_options(line.content);
  options.geometric_px = line.geometric_px;
  if (!line.lod.empty()) options.levels = line.lod != regulator::name(regulator::LodSelector::None);
  if (!line.size.empty()) options.display_px = display_from(line.size);
  return options;
}

void require_none(const std::vector<std::string>& warnings, bool strict, const std::string& file) {
  if (!strict || warnings.empty()) return;
  const bool is_one = warnings.size() == 1;
  throw InputError(
      (is_one ? "1 warning" : std::to_string(warnings.size()) + " warnings") + ", rule with --strict: none",
      file);
}

void say_content(const std::vector<std::string>& warnings, const std::vector<std::string>& notes) {
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "warning: %s\n", harmless(warning).c_str());
  for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", harmless(note).c_str());
}

namespace {

Sequence load_and_say(const std::string& name_or_path, const ContentOptions& options, bool strict) {
  Sequence sequence = load_sequence(name_or_path, options);
  say_content(sequence.warnings, sequence.notes);
  require_none(sequence.warnings, strict, sequence.file);
  return sequence;
}

}  // namespace

Sequence load_with_warnings(const std::string& name_or_path, const ContentWords& words) {
  return load_and_say(name_or_path, content_options(words), words.strict);
}

Sequence load_with_warnings(const CommandLine& line) {
  return load_and_say(line.sequence, content_options(line), line.content.strict);
}

namespace {

/// The whole scene in one pass, or out of shared buffers, has none of what these speak of.
void require_sprites(const CommandLine& line, const ResolvedRun& run) {
  const regulator::Policy policy = run.settings.regulator.policy;
  if (policy != regulator::Policy::Direct && policy != regulator::Policy::Predictive) return;
  const std::pair<const char*, bool> of_sprites[] = {
      {"--format exr-layers", run.options.format == FrameFormat::ExrLayers},
      {"--separate", run.options.separate},
      {"--overlay", run.options.overlay},
      {"--late-chunks", run.settings.late_chunks && !line.late_chunks.empty()},
      {line.audit_alone ? "audit" : "--audit", run.options.audit_every > 0}};
  for (const auto& [option, is_given] : of_sprites)
    if (is_given)
      throw InputError(std::string(option) + " needs sprites, but --policy is " +
                       std::string(regulator::name(policy)));
}

/// What a sprite contributes to a frame is known where sprites are laid over each other.
void require_sprite_channels(const ResolvedRun& run) {
  if (run.options.format != FrameFormat::ExrLayers) return;
  if (run.settings.compositor == Compositor::Extended)
    throw InputError(
        "--format exr-layers needs sprites that are laid over each other, but --compositor is extended, must "
        "be talisman");
}

/// Buffers that are joined by depth know no order: what needs one is refused.
void require_predictable(const Sequence& sequence, const Settings& settings) {
  if (settings.regulator.policy != regulator::Policy::Predictive) return;
  if (const std::string why = unpredictable(*sequence.scene, sequence.layers); !why.empty())
    throw InputError("--policy is 'predictive', but " + why, sequence.file);
}

}  // namespace

ResolvedRun resolve(const CommandLine& line, const Sequence& sequence, bool plan_only) {
  ResolvedRun run{settings_of(line, sequence), run_options_of(line, sequence, plan_only)};
  require_built_effects(sequence, run.settings);
  require_sprites(line, run);
  require_sprite_channels(run);
  require_predictable(sequence, run.settings);
  return run;
}

}  // namespace talisman::sequences
