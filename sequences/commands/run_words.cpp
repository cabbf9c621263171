// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/run_words.h"

#include <algorithm>

#include <glm/trigonometric.hpp>

#include "sequences/commands/option_group.h"
#include "sequences/commands/parse_error.h"
#include "sequences/commands/words.h"
#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

const std::string kProgressMeaning = alternatives(kProgressWords);
const std::string kBoundMeaning = "characteristic polyhedron: " + alternatives(kBoundWords);
/// What holds where neither the command line nor the sequence says anything.
const regulator::RegulatorOptions kUsual;

std::string in_words(const layers::ivec2& size) {
  return std::to_string(size.x) + "x" + std::to_string(size.y);
}

void add_run(CLI::App& command, CommandLine& line) {
  add_sequence_option(command, line);
  add_run_group(command, line, "out/NAME; plans: out/NAME-plan")
      .flag("--quiet", line.quiet, "no progress and no table; warnings and errors alone")
      .option("--decisions", line.decisions,
              "lines of decisions.jsonl: all, changed (where a layer is drawn, or comes and goes) or none; "
              "the report, "
              "explain, diff and a trace need all",
              line.decisions)
      .flag("--no-report", line.no_report, "leave out report.html, the page of the run")
      .flag("--no-thumbnails", line.no_thumbnails, "the page holds no pictures of frames")
      .flag("--force", line.force, "write into --out though it holds files that are not of a run");
}

void add_policy(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Policy")
      .option("--policy", line.policy, alternatives(kPolicyWords),
              std::string(word_of(kUsual.policy, kPolicyWords)))
      .option("--hold", line.hold, "policies hold and interpolate: drawn every N frames",
              std::to_string(kUsual.hold_frames))
      .option("--stagger", line.stagger, "policy interpolate: on: each layer has a beat of its own", "off")
      .option("--blend", line.blend,
              "a sprite that is drawn again fades in over K frames; the old one may be off by twice the "
              "threshold; 0: at once",
              std::to_string(kUsual.blend_frames))
      .option(
          "--lookahead", line.lookahead,
          "policy lookahead: frames ahead as of which a sprite may be drawn; predictive: frames of a slice, "
          "a power of --tree-k",
          std::to_string(kUsual.lookahead.frames))
      .option("--predict", line.predict,
              alternatives(kPredictionWords) +
                  ": what policies lookahead and predictive know of frames ahead, and what a late run "
                  "expects of the camera",
              "known; with --latency-ms: held")
      .option("--latency-ms", line.latency_ms,
              "RENDER or RENDER,WARP: decisions and sprites know the camera's poses of so long ago; sprites "
              "are warped once more just before they are shown, with poses of WARP ago",
              "0")
      .option("--tree-k", line.tree_k,
              "policy predictive: into how many parts an interval of the plan is cut",
              std::to_string(kUsual.predictive.children))
      .option("--joining", line.joining,
              "policy predictive: " + alternatives(kJoiningWords) + ": how the buffers become a frame",
              std::string(word_of(kUsual.predictive.joining, kJoiningWords)))
      .option("--motion-norm", line.motion_norm,
              "policy predictive: --geometric-px in any direction (euclid), or along x and along y (axis)",
              std::string(word_of(kUsual.predictive.norm, kMotionNormWords)))
      .option(
          "--intervals", line.intervals,
          "policy predictive: those of a slice are of equal length (fixed), or cut where most rests (data)",
          std::string(word_of(kUsual.predictive.intervals, kIntervalsWords)))
      .option("--adaptive", line.adaptive,
              "policy predictive: on: shorter slices after a surprise, longer ones while there is none",
              std::string(word_of(kUsual.predictive.adaptive, kSwitchWords)))
      .option("--accumulate", line.accumulate,
              "policies direct and predictive: a frame is the mean of M pictures over its time, 1 to 256",
              std::to_string(Settings().accumulate));
}

void add_regrouping(CLI::App& command, CommandLine& line) {
  const regulator::RegroupOptions& usual = kUsual.regroup;
  OptionGroup(command, "Grouping (policy threshold)")
      .option("--regroup", line.regroup,
              alternatives(kRegroupWords) + ": neighbours in the order share a sprite while that is cheaper",
              std::string(word_of(usual.by, kRegroupWords)))
      .option("--regroup-prices", line.regroup_prices,
              alternatives(kRegroupPricesWords) + ": what sprites cost, alone and shared",
              std::string(word_of(usual.prices, kRegroupPricesWords)))
      .option("--regroup-ceiling-ms", line.regroup_ceiling_ms,
              "the changes of one frame cost no more at once, modelled ms", "no limit")
      .option("--regroup-dwell", line.regroup_dwell, "frames for which a changed grouping stays at least",
              std::to_string(usual.dwell_frames));
  OptionGroup(command, "Refresh (policy threshold)")
      .option("--refresh", line.refresh,
              "what is drawn where a sprite is off in places: all of it (sprite), or those chunks (chunks)",
              std::string(word_of(kUsual.refresh, kRefreshWords)));
}

void add_levels(CLI::App& command, CommandLine& line) {
  const regulator::LodOptions& usual = kUsual.lod;
  OptionGroup(command, "Levels of detail (policies reference, threshold and budget)")
      .option("--lod", line.lod,
              alternatives(kLodWords) +
                  ": finest, by size, by size as the last frame's time asks, what gives most within "
                  "--budget-ms (policy budget)",
              std::string(word_of(usual.by, kLodWords)))
      .option("--benefit", line.lod_benefit,
              "--lod optimise: what a picture is worth: " + alternatives(kLodBenefitWords),
              std::string(word_of(usual.benefit, kLodBenefitWords)))
      .option("--first-appearance", line.first_appearance,
              "--lod optimise: what comes into view: " + alternatives(kFirstAppearanceWords),
              std::string(word_of(usual.first_appearance, kFirstAppearanceWords)))
      .option("--px-per-polygon", line.px_per_polygon,
              "--lod static: pixels for each triangle; feedback begins with it", shown(usual.px_per_polygon))
      .option("--feedback-gain", line.feedback_gain,
              "--lod feedback: by how much that grows after a frame twice as long as --budget-ms",
              shown(usual.feedback_gain));
}

void add_thresholds(CLI::App& command, CommandLine& line) {
  const regulator::Thresholds& usual = kUsual.thresholds;
  OptionGroup(command, "Thresholds")
      .option("--geometric-px", line.geometric_px,
              "threshold of the geometric fiducial, pixels; 0: reuse only what is identical",
              shown(usual.geometric_px))
      .option("--photometric", line.photometric,
              "threshold of the photometric fiducial, linear light, 1 is white; 0: not regulated",
              shown(usual.photometric))
      .option("--light-angle-deg", line.light_angle_deg,
              "threshold of the angle by which a light moves about a layer; 0: not regulated",
              shown(glm::degrees(usual.light_angle_rad)))
      .option("--shadow-map-px", line.shadow_map_px,
              "how far shadows may be off because their map is old, pixels; 0: maps are never old",
              shown(usual.shadow_map_px))
      .option("--turned-px", line.turned_px,
              "threshold of the size of a side that has turned to the eye, pixels; 0: not regulated",
              shown(usual.turned_px));
}

void add_budget(CLI::App& command, CommandLine& line) {
  const regulator::BudgetOptions& usual = kUsual.budget;
  OptionGroup(command, "Budget, of the policy budget")
      .option("--budget-polygons", line.budget_polygons,
              "triangles per frame; only first appearances may exceed it", "no limit")
      .option("--budget-pixels", line.budget_pixels, "sprite texels per frame, likewise", "no limit")
      .option("--budget-chunks", line.budget_chunks, "32x32 chunks of sprites per frame, likewise",
              "no limit")
      .option("--budget-ms", line.budget_ms,
              "modelled render time per frame on talisman-1996, as planned, likewise", "no limit")
      .option("--min-resolution", line.min_resolution,
              "least resolution of sprites that must fit, (0, 1]; 1: never lowered",
              shown(usual.min_resolution))
      .option("--cutoff-px", line.cutoff_px, "benefit up to which a layer is not drawn again, pixels",
              shown(usual.cutoff_px))
      .option("--choice", line.choice,
              "paper (by benefit over cost) or best (never worse, half the best at least)",
              std::string(word_of(usual.choice, kChoiceRuleWords)))
      .option("--depth-complexity", line.depth_complexity,
              "pixels filled per texel, by which those of --budget-ms are divided; 0: measured",
              shown(usual.depth_complexity))
      .flag("--budget-gap", line.budget_gap,
            "also report the best choice of each frame, and what the choice misses");
}

void add_layers(CLI::App& command, CommandLine& line) {
  const Sequence usual;
  OptionGroup(command, "Layers")
      .option("--warp", line.warp, "warp curve: " + alternatives(kCurveWords), usual.warp)
      .option("--color-warp", line.color_warp, "on, or off: as hardware without colour multipliers",
              std::string(word_of(kUsual.color_warp, kSwitchWords)))
      .option("--bound", line.bound, kBoundMeaning, std::string(word_of(usual.bound, kBoundWords)))
      .option("--material-points", line.material_points,
              "samples of the surface of each body that deforms or whose light is followed, 0 to 1024",
              std::to_string(usual.material_points))
      .option("--cycles", line.cycles,
              "layers that occlude each other in a cycle: merge (into one sprite) or keep (may be wrong)",
              std::string(word_of(usual.cycles, kCyclesWords)))
      .option("--compositor", line.compositor,
              "talisman: over only; extended: also out and plus with two image registers, so that layers "
              "that go round are not merged unless two of them meet",
              std::string(word_of(usual.compositor, kCompositorWords)))
      .option("--visibility", line.visibility,
              "what is not looked at: PRE,CELL,OBJECT, each none, or ctc or cto; frustum or eye; all but "
              "none,none,frustum need `cells`",
              text_of(VisibilityOptions()))
      .option("--expected-reuse", line.expected_reuse, "frames for which clipped sprites are enlarged",
              shown(usual.extents.expected_reuse_frames));
}

void add_drawing(OptionGroup group, CommandLine& line) {
  group.option("--shading", line.shading, alternatives(kShadingWords),
               std::string(word_of(chunker::RenderOptions().shading, kShadingWords)));
  group.option("--samples", line.samples, "of coverage and depth for each pixel: 1, 4 or 16",
               std::to_string(chunker::RenderOptions().samples));
  group.option("--resolution", line.resolution, "sprite texels per display pixel, each axis",
               shown(layers::PlacementOptions().resolution_scale));
  group.option("--compression", line.compression,
               "keep sprites compressed: quality 1 to 100 (about 10:1 at 85), 0: none", "0");
  group.option("--late-chunks", line.late_chunks,
               "on: a sprite's chunks are drawn when a frame first shows them: the same pictures in less "
               "time, but the "
               "counters leave out what was not drawn",
               std::string(word_of(Settings().late_chunks, kSwitchWords)));
}

void add_pictures(CLI::App& command, CommandLine& line) {
  OptionGroup group(command, "Pictures");
  group.option("--format", line.format, alternatives(kFormatWords), line.format);
  add_drawing(group, line);
  group.flag("--video", line.video, "also write video.mp4")
      .flag("--separate", line.separate,
            "also write each shade sprite alone, and the sum with its base (DIR/separate)")
      .flag("--overlay", line.overlay, "draw each sprite's outline, coloured by age")
      .flag("--quality", line.quality,
            "PSNR, SSIM and FLIP of each frame against reference and direct (slow)")
      .option("--audit", line.audit,
              "draw every N-th reuse of a layer fresh and compare: were the fiducials right? Sheets in "
              "DIR/audit",
              "none")
      .flag("--resume", line.resume, "continue a run that was stopped");
}

void add_decisions(CLI::App& command, CommandLine& line) {
  add_policy(command, line);
  add_thresholds(command, line);
  add_regrouping(command, line);
  add_levels(command, line);
  add_budget(command, line);
  add_layers(command, line);
}

}  // namespace

void add_sequence_option(CLI::App& command, CommandLine& line) {
  command
      .add_option("sequence", line.sequence, "name of a sequence, path of its YAML file, or path of a model")
      ->required();
}

OptionGroup add_run_group(CLI::App& command, CommandLine& line, const std::string& folder) {
  OptionGroup group(command, "Run");
  group.option("--out", line.out, "result folder", folder)
      .option("--frames", line.frames, "A-B, inclusive; the frames are those of the full run", "all")
      .option("--size", line.size, "display, WxH pixels", in_words(Sequence().display_px))
      .option("--threads", line.threads, "worker threads; 0: all cores. The bytes do not depend on it", "0")
      .option("--progress", line.progress, kProgressMeaning, line.progress);
  return group;
}

void add_run_options(CLI::App& command, CommandLine& line) {
  add_run(command, line);
  add_content_options(command, line.content);
  add_decisions(command, line);
}

void add_decision_options(CLI::App& command, CommandLine& line, const std::string& folder_of,
                          const std::string& folder) {
  add_sequence_option(command, line);
  OptionGroup(command, "Run")
      .option("--out", line.out, "folder of " + folder_of, folder)
      .option("--size", line.size, "display, WxH pixels", in_words(Sequence().display_px));
  add_content_options(command, line.content);
  add_decisions(command, line);
}

void add_audit_options(CLI::App& command, CommandLine& line) {
  OptionGroup group(command, "Audit");
  group.option("--every", line.audit, "one reuse of so many of each layer is drawn fresh", "8");
  add_drawing(group, line);
}

void add_content_options(CLI::App& command, ContentWords& words) {
  OptionGroup(command, "Content")
      .flag("--strict", words.strict, "what the content has and the picture lacks is an error")
      .option("--assets", words.assets, "a folder in which files that models name may lie, too")
      .option("--exposure", words.exposure,
              "illuminance that shows 1 on a white surface that faces the light: lux in models",
              "the file's, else 1")
      .option("--turntable", words.turntable, "seconds for one turn of the orbiting camera",
              "models: 20; sequences: the file's, else 5")
      .option("--seam", words.seam,
              "beyond the edges that they share layers are drawn as far as --geometric-px lets a crack open "
              "(auto), or not (none)",
              "the file's, else none")
      .flag("--no-stage", words.no_stage, "a bare model stands before black, on no ground");
}

void add_drawing_options(CLI::App& command, CommandLine& line) {
  add_drawing(OptionGroup(command, "Pictures"), line);
}

void add_picture_options(CLI::App& command, CommandLine& line) { add_pictures(command, line); }

void add_shard_options(CLI::App& command, CommandLine& line, bool plan_only) {
  OptionGroup group(command, "Parts, for many machines");
  group
      .option("--shard", line.shard,
              "i/N, i from 0: one of N ranges of the frames, into DIR/shards/i-of-N; talisman merge DIR "
              "joins them")
      .option("--plan", line.shard_plan,
              "folder of a plan with the same options: ranges that cost the same, instead of equally many "
              "frames");
  if (plan_only) group.flag("--resume", line.resume, "with --shard: leave a part that is complete as it is");
}

namespace {

/// "geometric_px" of "--geometric-px".
std::string as_keyword(std::string option) {
  option.erase(0, option.find_first_not_of('-'));
  std::replace(option.begin(), option.end(), '-', '_');
  return option;
}

}  // namespace

CommandLine command_line_from(const std::string& sequence, std::vector<std::string> words, bool plan_only) {
  CommandLine line;
  CLI::App app;
  add_run_options(app, line);
  if (!plan_only) add_picture_options(app, line);
  words.insert(words.end(), {"--", sequence});  // whatever it begins with
  std::reverse(words.begin(), words.end());     // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    const std::optional<UnknownOption> unknown = unknown_option(app, app.remaining());
    if (!unknown) throw InputError(error.what());
    throw InputError(
        "there is no option '" + as_keyword(unknown->written) + "'" +
        (unknown->nearest.empty() ? "" : "; did you mean '" + as_keyword(unknown->nearest) + "'?"));
  }
  return line;
}

}  // namespace talisman::sequences
