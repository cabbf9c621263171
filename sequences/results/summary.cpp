// SPDX-License-Identifier: Apache-2.0
// summary.json and the table that the tool prints.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "sequences/files/number_text.h"
#include "sequences/results/compression_json.h"
#include "sequences/results/frame_lines.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Means over the frames; PSNR is that of the mean squared error, so that identical frames do not make it
/// infinite.
struct MeanQuality {
  double mse = 0, ssim = 0, flip = 0;
  int frames = 0;
  double psnr_db() const { return mse > 0 ? 10 * std::log10(255.0 * 255.0 / mse) : INFINITY; }
};

MeanQuality mean_quality(const Summary& summary, Quality FrameQuality::*which) {
  MeanQuality mean;
  for (const FrameLine& line : summary.frames) {
    if (!line.quality) continue;
    const Quality& q = (*line.quality).*which;
    mean.mse += std::isfinite(q.psnr_db) ? 255.0 * 255.0 / std::pow(10.0, q.psnr_db / 10) : 0;
    mean.ssim += q.ssim;
    mean.flip += q.flip;
    ++mean.frames;
  }
  if (mean.frames == 0) return mean;
  for (double* value : {&mean.mse, &mean.ssim, &mean.flip}) *value /= mean.frames;
  return mean;
}

Json json_of(const MeanQuality& q) {
  return {{"psnr_db", number_or_null(q.psnr_db())}, {"ssim", q.ssim}, {"flip", q.flip}};
}

bool has_quality(const Summary& s) { return !s.frames.empty() && s.frames.front().quality.has_value(); }

std::string format(const char* pattern, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string percent(double part, double whole) { return whole > 0 ? percent_of(part, whole) + " %" : "-"; }

/// "123 k", "4.56 M"
std::string magnitude(double value) {
  if (value >= 1e9) return format("%.2f G", value / 1e9);
  if (value >= 1e6) return format("%.2f M", value / 1e6);
  if (value >= 1e4) return format("%.1f k", value / 1e3);
  return format("%.0f", value);
}

Json layers_json(const Summary& s) {
  const int frames = static_cast<int>(s.frames.size());
  Json json = Json::array();
  for (const LayerSummary& layer : s.layers)
    json.push_back({{"name", layer.name},
                    {"parts", layer.parts},
                    {"polygons", layer.polygons},
                    {"renders", layer.renders},
                    {"merged_renders", layer.merged_renders},
                    {"aggregate", layer.is_aggregate},
                    {"frames_shown", layer.frames_shown},
                    {"update_rate", layer.update_rate(frames)},
                    {"mean_geometric_px", layer.mean_geometric_px()},
                    {"max_geometric_px", layer.max_geometric_px},
                    {"mean_resolution", layer.mean_resolution()},
                    {"sprite_px", {layer.sprite_px.x, layer.sprite_px.y}}});
  return json;
}

Json effects_json(const Summary& s) {
  Json json = Json::object();
  for (std::size_t e = 0; e < s.effects.size(); ++e)
    json[std::string(layers::name(s.effects[e].effect))] = {
        {"called", s.effects[e].called}, {"why", s.effects[e].why}, {"passes", s.effect_passes[e]}};
  return json;
}

/// Totals over the frames in which it was sorted; null if there are none.
Json visibility_json(const Summary& s) {
  layers::VisibilityCounters sum;
  std::int64_t frames = 0, cyclic_frames = 0, merged_parts = 0;
  double sort_ms = 0, slowest_ms = 0;
  for (const FrameLine& line : s.frames) {
    if (!line.visibility) continue;
    const layers::VisibilityCounters& c = line.visibility->counters;
    ++frames;
    cyclic_frames += c.merged_components + line.visibility->resolved.components > 0;
    sum.queries += c.queries, sum.pairs += c.pairs, sum.exact_tests += c.exact_tests, sum.swaps += c.swaps;
    sum.merged_layers += c.merged_layers;
    merged_parts += line.visibility->merged_parts;
    sort_ms += line.visibility->sort_ms;
    slowest_ms = std::max(slowest_ms, line.visibility->sort_ms);
  }
  if (frames == 0) return nullptr;
  const ResolvedCounters resolved = s.resolved();
  return {{"frames_sorted", frames},
          {"frames_with_cycles", cyclic_frames},
          {"queries", sum.queries},
          {"pairs", sum.pairs},
          {"exact_tests", sum.exact_tests},
          {"swaps", sum.swaps},
          {"merged_layers", sum.merged_layers},
          {"merged_parts", merged_parts},
          {"resolved_components", resolved.components},
          {"resolved_layers", resolved.layers},
          {"expression_registers", resolved.registers},
          {"expression_reads", resolved.reads},
          {"sort_ms", sort_ms},
          {"slowest_sort_ms", slowest_ms}};
}

double sort_ms(const Summary& s) {
  double sum = 0;
  for (const FrameLine& line : s.frames) sum += line.visibility ? line.visibility->sort_ms : 0;
  return sum;
}

std::string layer_rows(const Summary& s) {
  const int frames = static_cast<int>(s.frames.size());
  std::string text = format("  %-24s %9s %8s %8s %9s %9s %11s\n", "layer", "polygons", "renders", "rate",
                            "mean px", "max px", "sprite px");
  for (const LayerSummary& layer : s.layers) {
    const std::string name = layer.name.size() <= 24 ? layer.name : layer.name.substr(0, 21) + "...";
    const std::string sprite = format("%dx%d", layer.sprite_px.x, layer.sprite_px.y);
    text += format("  %-24s %9d %8d %7.1f%% %9.3f %9.3f %11s\n", name.c_str(), layer.polygons, layer.renders,
                   100 * layer.update_rate(frames), layer.mean_geometric_px(), layer.max_geometric_px,
                   sprite.c_str());
  }
  return text;
}

std::string quality_rows(const Summary& s) {
  std::string text;
  const auto row = [&](const char* label, Quality FrameQuality::*which) {
    const MeanQuality q = mean_quality(s, which);
    const std::string psnr = std::isfinite(q.psnr_db()) ? format("%6.2f dB", q.psnr_db()) : "identical";
    text += format("  %-30s PSNR %9s  SSIM %.4f  FLIP %.4f\n", label, psnr.c_str(), q.ssim, q.flip);
  };
  row("shown against direct", &FrameQuality::total);
  row("  of it by reuse", &FrameQuality::reuse);
  row("  of it by resampling", &FrameQuality::resampling);
  return text;
}

CompressionReport total_compression(const Summary& s) {
  CompressionReport sum;
  for (const FrameLine& line : s.frames)
    if (line.compression) sum += *line.compression;
  return sum;
}

bool has_compression(const Summary& s) { return s.compression_quality && !s.planned_only; }

std::string compression_row(const Summary& s) {
  const CompressionReport c = total_compression(s);
  return format(
      "  compression       %.1f : 1 at quality %d, PSNR %.1f dB; cache %.1f %% hits, %s bytes read\n",
      c.ratio(), *s.compression_quality, c.error.color_psnr_db(), 100 * c.cache.hit_rate(),
      magnitude(static_cast<double>(c.cache.bytes_read)).c_str());
}

std::string time_row(const Summary& s) {
  if (s.planned_only) return format("  wall time         plan %.3f s\n", s.total(&FrameLine::plan_ms) / 1e3);
  return format("  wall time         plan %.3f s, render %.2f s, composite %.2f s, files %.2f s\n",
                s.total(&FrameLine::plan_ms) / 1e3, s.total(&FrameLine::render_ms) / 1e3,
                s.total(&FrameLine::composite_ms) / 1e3, s.total(&FrameLine::io_ms) / 1e3);
}

}  // namespace

ResolvedCounters Summary::resolved() const {
  ResolvedCounters sum;
  for (const FrameLine& line : frames) {
    if (!line.visibility) continue;
    const ResolvedCounters& r = line.visibility->resolved;
    sum.components += r.components;
    sum.layers += r.layers;
    sum.reads += r.reads;
    sum.registers = std::max(sum.registers, r.registers);
  }
  return sum;
}

std::string json_of(const Summary& s) {
  const double frames = static_cast<double>(s.frames.size());
  const auto measured = [&s](auto value) { return s.planned_only ? Json(nullptr) : Json(value); };
  Json json = {{"schema", "talisman.summary/1"},
               {"sequence", s.sequence},
               {"policy", s.policy},
               {"warp", s.warp},
               {"compositor", s.compositor},
               {"frames", s.frames.size()},
               {"first_frame", s.frames.empty() ? 0 : s.frames.front().frame},
               {"display_px", {s.display_px.x, s.display_px.y}},
               {"layers", layers_json(s)},
               {"mean_update_rate", s.mean_update_rate()},
               {"cost_weighted_update_rate", s.cost_weighted_update_rate()},
               {"polygons_rendered", s.total(&FrameLine::polygons_rendered)},
               {"polygons_reference", s.total(&FrameLine::polygons_reference)},
               {"pixels_rendered", s.total(&FrameLine::pixels_rendered)},
               {"pixels_reference", s.total(&FrameLine::pixels_reference)},
               {"pixels_filled", measured(s.total(&FrameLine::pixels_filled))},
               {"pixels_composited", measured(s.total(&FrameLine::pixels_composited))},
               {"chunks_rendered", measured(s.total(&FrameLine::chunks_rendered))},
               {"chunks_clear", measured(s.total(&FrameLine::chunks_clear))},
               {"effects", effects_json(s)},
               {"visibility", visibility_json(s)},
               {"modelled_ms", measured(frames > 0 ? s.total(&FrameLine::modelled_ms) / frames : 0)},
               {"modelled_profile", "talisman-1996"},
               {"planning_us_per_layer_and_frame", s.planning_us_per_layer_and_frame()},
               {"wall_ms",
                {{"plan", s.total(&FrameLine::plan_ms)},
                 {"sort", sort_ms(s)},
                 {"render", measured(s.total(&FrameLine::render_ms))},
                 {"composite", measured(s.total(&FrameLine::composite_ms))},
                 {"io", measured(s.total(&FrameLine::io_ms))}}}};
  if (has_compression(s)) {
    json["compression"] = compression_json(total_compression(s));
    json["compression"]["quality"] = *s.compression_quality;
  }
  if (const GapSummary gap = s.budget_gap(); gap.frames > 0)
    json["budget_gap"] = {
        {"mean", gap.mean}, {"max", gap.max}, {"frames", gap.frames}, {"exact_frames", gap.exact_frames}};
  if (has_quality(s)) {
    json["quality"] = json_of(mean_quality(s, &FrameQuality::total));
    json["quality_of_reuse"] = json_of(mean_quality(s, &FrameQuality::reuse));
    json["quality_of_resampling"] = json_of(mean_quality(s, &FrameQuality::resampling));
  }
  return json.dump(2) + "\n";
}

std::string table_of(const Summary& s) {
  const double rendered = static_cast<double>(s.total(&FrameLine::polygons_rendered));
  const double reference = static_cast<double>(s.total(&FrameLine::polygons_reference));
  std::string text = format("%s: %zu %s of %dx%d px, policy %s, warp %s\n\n", s.sequence.c_str(),
                            s.frames.size(), s.frames.size() == 1 ? "frame" : "frames", s.display_px.x,
                            s.display_px.y, s.policy.c_str(), s.warp.c_str());
  text += layer_rows(s) + "\n";
  text += format("  update rate       %.1f %% mean over layers, %.1f %% weighted by polygons\n",
                 100 * s.mean_update_rate(), 100 * s.cost_weighted_update_rate());
  text += format("  polygons          %s of %s in view (%s of reference)\n", magnitude(rendered).c_str(),
                 magnitude(reference).c_str(), percent(rendered, reference).c_str());
  const double pixels = static_cast<double>(s.total(&FrameLine::pixels_rendered));
  const double pixels_reference = static_cast<double>(s.total(&FrameLine::pixels_reference));
  text += format("  sprite pixels     %s of %s (%s of reference)\n", magnitude(pixels).c_str(),
                 magnitude(pixels_reference).c_str(), percent(pixels, pixels_reference).c_str());
  if (!s.planned_only)
    text += format(
        "  modelled          %.2f ms a frame on talisman-1996\n",
        s.frames.empty() ? 0 : s.total(&FrameLine::modelled_ms) / static_cast<double>(s.frames.size()));
  if (const GapSummary gap = s.budget_gap(); gap.frames > 0)
    text += format(
        "  greedy choice     misses %.2f %% of the best choice's benefit in the mean, %.1f %% at most\n"
        "                    (the best proved in %d of %d frames)\n",
        100 * gap.mean, 100 * gap.max, gap.exact_frames, gap.frames);
  if (const ResolvedCounters r = s.resolved(); r.components > 0)
    text +=
        format("  expressions       %d, for %d sprites that would have been merged; %d reads, %d registers\n",
               r.components, r.layers, r.reads, r.registers);
  text += format("  planning          %.2f us per layer and frame\n", s.planning_us_per_layer_and_frame());
  if (has_compression(s)) text += compression_row(s);
  text += time_row(s);
  if (has_quality(s)) text += "\n" + quality_rows(s);
  return text;
}

}  // namespace talisman::sequences
