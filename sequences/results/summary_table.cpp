// SPDX-License-Identifier: Apache-2.0
// The table that the tool prints at the end of a run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "sequences/files/number_text.h"
#include "sequences/files/quoted.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/layer_words.h"

namespace talisman::sequences {

namespace {

/// "123 k", "4.56 M"
std::string magnitude(double value) {
  if (value >= 1e9) return formatted("%.2f G", value / 1e9);
  if (value >= 1e6) return formatted("%.2f M", value / 1e6);
  if (value >= 1e4) return formatted("%.1f k", value / 1e3);
  return formatted("%.0f", value);
}

/// Most often; and of what was never drawn by itself, what is known of that.
std::string why_drawn(const LayerSummary& row) {
  if (row.renders > 0 || row.is_shadow_map) return row.reasons.text();
  if (row.merged_renders > 0) return formatted("with those it is merged with, %d times", row.merged_renders);
  return row.frames_shown > 0 ? "before these frames" : "not in view, or merged";
}

std::string layer_rows(const Summary& s) {
  const int frames = s.frame_count();
  std::string text = formatted("  %-24s %9s %8s %8s %7s %9s %9s %11s  %s\n", "layer", "polygons", "renders",
                               "rate", "cost", "mean px", "max px", "sprite px", "why drawn");
  for (const LayerSummary* row : s.rows()) {
    const std::string name = column_of(row->name);
    const std::string cost = formatted("%.1f%%", 100 * s.share_of_cost(*row));
    if (row->is_mirror) {
      text += formatted("  %s %9s %8d %8s %7s\n", name.c_str(), "", row->renders, "", cost.c_str());
      continue;
    }
    const std::string sprite = formatted("%dx%d", row->sprite_px.x, row->sprite_px.y);
    const std::string why = why_drawn(*row);
    text += formatted("  %s %9d %8d %7.1f%% %7s %9.3f %9.3f %11s%s%s\n", name.c_str(), row->polygons,
                      row->renders, 100 * row->update_rate(frames), cost.c_str(), row->mean_geometric_px(),
                      row->max_geometric_px, sprite.c_str(), why.empty() ? "" : "  ", why.c_str());
  }
  return text;
}

std::string quality_rows(const RunRow& run) {
  std::string text;
  const auto row = [&](const char* label, const MeanQuality& q) {
    const std::string psnr = std::isfinite(q.psnr_db()) ? formatted("%6.2f dB", q.psnr_db()) : "identical";
    text += formatted("  %-30s PSNR %9s  SSIM %.4f  FLIP %.4f\n", label, psnr.c_str(), q.ssim, q.flip);
  };
  row("shown against direct", *run.quality);
  row("  of it by reuse", *run.quality_of_reuse);
  row("  of it by resampling", *run.quality_of_resampling);
  return text;
}

/// Empty where no layers share edges.
std::string seam_row(const RunRow& run) {
  if (!run.sums.open_seams()) return {};
  const OpenSeams& open = *run.sums.open_seams();
  const std::string all =
      formatted("  %-30s %lld pixels", "open at shared edges", static_cast<long long>(open.pixels));
  return open.worst_frame < 0 ? all + "\n"
                              : all + formatted(", at most %lld in one frame, %d\n",
                                                static_cast<long long>(open.most), open.worst_frame);
}

/// Empty where nothing moves in pictures.
std::string upload_row(const RunRow& run) {
  const std::optional<std::int64_t>& bytes = run.sums.upload_bytes();
  return bytes ? formatted("  %-17s %s bytes of new frames of pictures\n", "uploaded",
                           magnitude(static_cast<double>(*bytes)).c_str())
               : "";
}

std::string share_row(const char* label, std::int64_t part, std::int64_t whole, const char* of) {
  const double a = static_cast<double>(part), b = static_cast<double>(whole);
  return formatted("  %-17s %s of %s%s (%s %% of reference)\n", label, magnitude(a).c_str(),
                   magnitude(b).c_str(), of, percent_of(a, b).c_str());
}

/// Renders that no row of a member shows, though the mean counts them for it.
std::string merged_row(const Summary& s) {
  std::vector<std::string> names;
  int fewest = std::numeric_limits<int>::max(), most = 0;
  for (const LayerSummary& layer : s.layers) {
    if (layer.merged_renders == 0) continue;
    names.push_back(layer.name);
    fewest = std::min(fewest, layer.merged_renders);
    most = std::max(most, layer.merged_renders);
  }
  if (names.empty()) return {};
  const std::string times = fewest == most ? formatted("%d", most) : formatted("%d to %d", fewest, most);
  return formatted("                    with %s %s in merged sprites of each of %s\n", times.c_str(),
                   most == 1 ? "render" : "renders", quoted(names).c_str());
}

std::string work_rows(const Summary& s) {
  std::string text = formatted("  update rate       %.1f %% mean over layers, %.1f %% weighted by polygons\n",
                               100 * s.mean_update_rate(), 100 * s.cost_weighted_update_rate());
  text += merged_row(s);
  text += share_row("polygons", s.polygons_rendered(),
                    s.total([](const FrameLine& line) { return line.polygons.reference; }), "");
  text += share_row("pixels", s.pixels_rendered(),
                    s.total([](const FrameLine& line) { return line.pixels.reference; }), "");
  const double frames = std::max(1, s.frame_count());
  if (s.planned_only)
    return text + formatted("  modelled          %.2f ms of rendering a frame on talisman-1996, as planned\n",
                            s.total(&FrameLine::modelled_drawing_ms) / frames);
  return text + formatted("  modelled          %.2f ms a frame on talisman-1996\n",
                          s.total(&FrameLine::modelled_ms) / frames);
}

/// What the budget put off, and what it could never pay.
std::string deferred_rows(const Summary& s) {
  if (s.frames_deferred == 0) return {};
  std::string text = formatted("  put off           something in %d of %d frames, for want of budget\n",
                               s.frames_deferred, s.frame_count());
  for (const auto* rows : {&s.layers, &s.shadow_maps})
    for (const LayerSummary& row : *rows)
      if (row.frames_over_budget > 0)
        text += "                    " + row.name +
                formatted(": dearer than the whole budget in %d frames, error up to %.3f px\n",
                          row.frames_over_budget, row.max_geometric_px);
  return text;
}

/// What only some runs have.
std::string special_rows(const RunRow& run) {
  std::string text = deferred_rows(run.summary);
  if (const GapSummary& gap = run.gap; gap.frames > 0)
    text += formatted(
        "  choice            misses %.2f %% of the best choice's benefit in the mean, %.1f %% at most\n"
        "                    (the best proved in %d of %d frames)\n",
        100 * gap.mean, 100 * gap.max, gap.exact_frames, gap.frames);
  if (const LodTotals& lod = run.sums.lod(); lod.frames > 0)
    text += formatted(
        "  levels of detail  %.2f %% of the upper bound of the benefit; %lld times a layer is skipped\n"
        "                    in %d of %d frames the coarsest pictures alone exceed the budget\n",
        lod.upper_bound > 0 ? 100 * lod.benefit / lod.upper_bound : 100.0,
        static_cast<long long>(lod.skipped), lod.over, lod.frames);
  if (const std::int64_t surprises = run.sums.surprises().value_or(0); surprises > 0)
    text += formatted("  surprises         %lld: the plan was dropped, and the frame drawn whole\n",
                      static_cast<long long>(surprises));
  if (const std::optional<RefreshReport>& refresh = run.sums.refresh())
    text += formatted(
        "  refreshed         %s chunks alone, %d times; steps at their borders at most %.3f px,\n"
        "                    over the threshold at %d groups of triangles\n",
        magnitude(static_cast<double>(refresh->chunks)).c_str(), refresh->layers, refresh->step_px,
        refresh->torn_borders);
  if (const LatencyTotals& late = run.sums.latency(); late.frames > 0)
    text += formatted(
        "  old poses         the camera as shown is off by %.3f deg in the mean, %.3f at most\n"
        "                    layers by %.3f px in the mean, %.1f at most; %d times one is missing\n",
        late.mean(&LatencyReport::shown_turn_deg), late.most.shown_turn_deg,
        late.mean(&LatencyReport::true_mean_px), late.most.true_px, late.sum.layers_missing);
  if (const ResolvedCounters& r = run.resolved; r.components > 0)
    text += formatted(
        "  expressions       %d, for %d sprites that would have been merged; %d reads, %d operators, "
        "%d registers\n",
        r.components, r.layers, r.reads, r.operators, r.registers);
  return text;
}

std::string compression_row(const RunRow& run) {
  const CompressionReport& c = *run.compression;
  return formatted(
      "  compression       %.1f : 1 at quality %d, PSNR %.1f dB; cache %.1f %% hits, %s bytes read\n",
      c.ratio(), *run.summary.compression_quality, c.error.color_psnr_db(), 100 * c.cache.hit_rate(),
      magnitude(static_cast<double>(c.cache.bytes_read)).c_str());
}

std::string time_row(const Summary& s) {
  const auto seconds = [&s](double FrameTimes::*time) {
    return s.total([time](const FrameLine& line) { return line.times.*time; }) / 1e3;
  };
  if (s.planned_only) return formatted("  wall time         plan %.3f s\n", seconds(&FrameTimes::plan_ms));
  return formatted("  wall time         plan %.3f s, render %.2f s, composite %.2f s, files %.2f s\n",
                   seconds(&FrameTimes::plan_ms), seconds(&FrameTimes::render_ms),
                   seconds(&FrameTimes::composite_ms), seconds(&FrameTimes::io_ms));
}

}  // namespace

std::string table_of(const Summary& s) {
  const RunRow run(s);
  std::string text = formatted("%s: %d %s of %dx%d px, policy %s, warp %s\n\n", s.sequence.c_str(),
                               s.frame_count(), s.frame_count() == 1 ? "frame" : "frames", s.display_px.x,
                               s.display_px.y, s.policy.c_str(), s.warp.c_str());
  text += layer_rows(s) + "\n" + work_rows(s) + special_rows(run) + upload_row(run);
  text += formatted("  planning          %.2f us per layer and frame\n", s.planning_us_per_layer_and_frame());
  if (run.compression) text += compression_row(run);
  text += time_row(s);
  if (run.quality) text += "\n" + quality_rows(run) + seam_row(run);
  if (!s.audit.empty()) text += "\n" + table_of(s.audit);
  return text;
}

}  // namespace talisman::sequences
