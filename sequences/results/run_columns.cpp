// SPDX-License-Identifier: Apache-2.0
#include "regulator/profile.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/shared_columns.h"

namespace talisman::sequences {

namespace {

using RunColumns = std::vector<Column<RunRow>>;

template <typename Get>
Column<RunRow> of_run(std::string name, std::string unit, std::string meaning, Get get) {
  const std::string path = name;
  return computed<RunRow>(std::move(name), path, std::move(unit), std::move(meaning), get);
}

/// Null in a run that was only planned.
template <typename Get>
Column<RunRow> run_measured(std::string name, std::string unit, std::string meaning, Get get) {
  Column<RunRow> column = of_run(std::move(name), std::move(unit), std::move(meaning), get);
  column.get = [](const RunRow& row) {
    return row.summary.planned_only ? Value(Null{}) : value_of(Get{}(row));
  };
  return column;
}

/// Room for what other tables fill in.
Column<RunRow> place(const char* path) {
  return computed<RunRow>("", path, "", "", [](const RunRow&) { return Value(Null{}); });
}

RunColumns what_was_run() {
  return {of_run("sequence", "", "name of the sequence", [](const RunRow& r) { return r.summary.sequence; }),
          of_run("policy", "", "of the regulator", [](const RunRow& r) { return r.summary.policy; }),
          of_run("warp", "", "curve of the warps", [](const RunRow& r) { return r.summary.warp; }),
          of_run("compositor", "", "talisman (over only) or extended",
                 [](const RunRow& r) { return r.summary.compositor; }),
          of_run("frames", "frames", "of this run", [](const RunRow& r) { return r.summary.frame_count(); }),
          of_run("first_frame", "", "number of the first of them",
                 [](const RunRow& r) { return r.sums.first_frame(); }),
          computed<RunRow>("display_width_px", "display_px/0", "px", "of the display",
                           [](const RunRow& r) { return r.summary.display_px.x; }),
          computed<RunRow>("display_height_px", "display_px/1", "px", "of the display",
                           [](const RunRow& r) { return r.summary.display_px.y; }),
          place("layers")};
}

std::int64_t total_of(const RunRow& row, std::int64_t (*number)(const FrameLine&)) {
  return row.summary.total(number);
}

RunColumns run_work() {
  return {
      of_run("mean_update_rate", "",
             "mean over the author's layers of the share of frames in which they are drawn",
             [](const RunRow& r) { return r.summary.mean_update_rate(); }),
      of_run("cost_weighted_update_rate", "", "the same, weighted by polygons",
             [](const RunRow& r) { return r.summary.cost_weighted_update_rate(); }),
      of_run("polygons_rendered", "triangles", "of the layers rendered, and of casters in shadow maps",
             [](const RunRow& r) { return r.summary.polygons_rendered(); }),
      of_run("polygons_reference", "triangles",
             "what `reference` would draw: all layers in view, and the shadow maps that changed",
             [](const RunRow& r) {
               return total_of(r, [](const FrameLine& l) { return l.polygons.reference; });
             }),
      of_run("pixels_rendered", "texels",
             "of the rectangles of the sprites rendered, of mirrored pictures and of shadow maps",
             [](const RunRow& r) { return r.summary.pixels_rendered(); }),
      of_run(
          "pixels_reference", "texels", "what `reference` would draw",
          [](const RunRow& r) { return total_of(r, [](const FrameLine& l) { return l.pixels.reference; }); }),
      run_measured(
          "pixels_filled", "texels", "writes by the renderer, and texels of shadow maps",
          [](const RunRow& r) { return total_of(r, [](const FrameLine& l) { return l.pixels.filled; }); }),
      run_measured("pixels_composited", "pixels", "reads of sprites by the compositor",
                   [](const RunRow& r) {
                     return total_of(r, [](const FrameLine& l) { return l.pixels.composited; });
                   }),
      run_measured(
          "chunks_rendered", "32×32 chunks", "in which something was drawn",
          [](const RunRow& r) { return total_of(r, [](const FrameLine& l) { return l.chunks.rendered; }); }),
      run_measured(
          "chunks_clear", "32×32 chunks", "of the sprites rendered, in which nothing was",
          [](const RunRow& r) { return total_of(r, [](const FrameLine& l) { return l.chunks.clear; }); }),
      run_measured("depth_complexity", "",
                   "pixels_filled over pixels_rendered: below 1 where rectangles are clear",
                   [](const RunRow& r) {
                     const double texels = static_cast<double>(r.summary.pixels_rendered());
                     const auto filled = total_of(r, [](const FrameLine& l) { return l.pixels.filled; });
                     return texels > 0 ? static_cast<double>(filled) / texels : 0;
                   }),
      of_run("frames_deferred", "frames", "in which something was put off for want of budget",
             [](const RunRow& r) { return r.summary.frames_deferred; }),
      place("effects")};
}

template <typename Get>
Column<RunRow> run_sorting(const char* name, const char* unit, const char* meaning, Get get) {
  return computed<RunRow>(std::string("visibility_") + name, std::string("visibility/") + name, unit, meaning,
                          get);
}

RunColumns run_visibility() {
  return {
      run_sorting("frames_sorted", "frames", "in which layers were sorted",
                  [](const RunRow& r) { return r.visibility.frames; }),
      run_sorting("frames_with_cycles", "frames", "in which layers occluded each other in a cycle",
                  [](const RunRow& r) { return r.visibility.cyclic_frames; }),
      run_sorting("queries", "bodies", "whose possible occluders were looked up",
                  [](const RunRow& r) { return r.visibility.queries; }),
      run_sorting("pairs", "pairs", "of bodies that extents cannot tell apart in view",
                  [](const RunRow& r) { return r.visibility.pairs; }),
      run_sorting("exact_tests", "pairs", "of these, tested on the hulls",
                  [](const RunRow& r) { return r.visibility.exact_tests; }),
      run_sorting("swaps", "layers", "that moved within last frame's line",
                  [](const RunRow& r) { return r.visibility.swaps; }),
      run_sorting("merged_layers", "layers", "that shared a sprite",
                  [](const RunRow& r) { return r.visibility.merged_layers; }),
      run_sorting("merged_parts", "parts", "of the merged sprites",
                  [](const RunRow& r) { return r.visibility.merged_parts; }),
      run_sorting("resolved_components", "components", "cycles that an expression of the compositor shows",
                  [](const RunRow& r) { return r.resolved.components; }),
      run_sorting("resolved_layers", "layers", "in these", [](const RunRow& r) { return r.resolved.layers; }),
      run_sorting("expression_registers", "registers", "images that one expression keeps at once, at most",
                  [](const RunRow& r) { return r.resolved.registers; }),
      run_sorting("expression_operators", "operators", "evaluated by the expressions, each over an image",
                  [](const RunRow& r) { return r.resolved.operators; }),
      run_sorting("expression_reads", "reads", "of sprites by the expressions",
                  [](const RunRow& r) { return r.resolved.reads; })};
}

RunColumns modelled() {
  return {run_measured("modelled_ms", "ms", "modelled time of a frame, mean over the frames",
                       [](const RunRow& r) {
                         const double frames = r.summary.frame_count();
                         return frames > 0 ? r.summary.total(&FrameLine::modelled_ms) / frames : 0;
                       }),
          of_run("modelled_drawing_ms", "ms", "of it the renderer's part, as planned, mean over the frames",
                 [](const RunRow& r) {
                   const double frames = r.summary.frame_count();
                   return frames > 0 ? r.summary.total(&FrameLine::modelled_drawing_ms) / frames : 0;
                 }),
          of_run("modelled_profile", "", "on this hardware",
                 [](const RunRow&) { return regulator::talisman_1996().name; })};
}

RunColumns compression() {
  RunColumns columns = compression_columns<RunRow>([](auto& r) -> auto& { return *r.compression; });
  columns.push_back(computed<RunRow>("compression_quality", "compression/quality", "", "1 to 100",
                                     [](const RunRow& r) { return r.summary.compression_quality; }));
  return columns;
}

RunColumns run_motion_ahead() {
  return {
      computed<RunRow>("lookahead_judged", "lookahead/judged", "",
                       "pairs of an instant ahead and a frame, of which it was asked whether the one's "
                       "sprite would serve the other",
                       [](const RunRow& r) { return r.sums.lookahead().value_or(LookaheadReport{}).judged; }),
      computed<RunRow>(
          "lookahead_evaluated", "lookahead/evaluated", "", "of these, by fit and fiducials",
          [](const RunRow& r) { return r.sums.lookahead().value_or(LookaheadReport{}).evaluated; }),
      computed<RunRow>("predictive_surprises", "predictive/surprises", "",
                       "in which a plan was dropped, and the frame drawn whole",
                       [](const RunRow& r) { return r.sums.surprises().value_or(0); }),
      computed<RunRow>("predictive_edge_pixels", "predictive/edge_pixels", "pixels",
                       "of all frames, covered in part: a join may show them too dark",
                       [](const RunRow& r) { return r.sums.edge_pixels(); })};
}

RunColumns run_budget_gap() {
  return {computed<RunRow>("budget_gap_mean", "budget_gap/mean", "",
                           "share of the best choice's benefit that was missed, mean over exact_frames",
                           [](const RunRow& r) { return r.gap.mean; }),
          computed<RunRow>("budget_gap_max", "budget_gap/max", "", "the largest of them",
                           [](const RunRow& r) { return r.gap.max; }),
          computed<RunRow>("budget_gap_frames", "budget_gap/frames", "frames", "with a choice",
                           [](const RunRow& r) { return r.gap.frames; }),
          computed<RunRow>("budget_gap_exact_frames", "budget_gap/exact_frames", "frames",
                           "of them, the best choice was proved",
                           [](const RunRow& r) { return r.gap.exact_frames; })};
}

RunColumns run_latency() {
  const auto column = [](const char* name, const char* unit, const char* meaning, auto get) {
    return computed<RunRow>(std::string("latency_") + name, std::string("latency/") + name, unit, meaning,
                            get);
  };
  using L = LatencyReport;
  return {
      column("drawn_turn_mean_deg", "°",
             "between the camera that decisions and sprites know and the true one, mean over the frames",
             [](const RunRow& r) { return r.sums.latency().mean(&L::drawn_turn_deg); }),
      column("drawn_turn_max_deg", "°", "the largest of them",
             [](const RunRow& r) { return r.sums.latency().most.drawn_turn_deg; }),
      column("shown_turn_mean_deg", "°", "of the camera that the last warp knows, likewise",
             [](const RunRow& r) { return r.sums.latency().mean(&L::shown_turn_deg); }),
      column("shown_turn_max_deg", "°", "likewise",
             [](const RunRow& r) { return r.sums.latency().most.shown_turn_deg; }),
      column("true_mean_px", "px", "true_px of the layers that are shown: their mean, mean over the frames",
             [](const RunRow& r) { return r.sums.latency().mean(&L::true_mean_px); }),
      column("true_max_px", "px", "the largest of all",
             [](const RunRow& r) { return r.sums.latency().most.true_px; }),
      column("layers_missing", "layers",
             "that the true camera sees and a frame does not show, added up over the frames",
             [](const RunRow& r) { return r.sums.latency().sum.layers_missing; })};
}

RunColumns run_levels() {
  return {computed<RunRow>("lod_frames_over", "lod/frames_over", "frames",
                           "in which the coarsest pictures alone exceed the budget",
                           [](const RunRow& r) { return r.sums.lod().over; }),
          computed<RunRow>("lod_skipped", "lod/skipped", "layers", "in view and not shown, over all frames",
                           [](const RunRow& r) { return r.sums.lod().skipped; }),
          computed<RunRow>("lod_share_of_bound", "lod/share_of_bound", "",
                           "benefit of what was chosen over its upper bound, of all frames together",
                           [](const RunRow& r) {
                             const LodTotals& lod = r.sums.lod();
                             return lod.upper_bound > 0 ? lod.benefit / lod.upper_bound : 1.0;
                           })};
}

template <typename Which>
RunColumns run_quality(const std::string& group, const std::string& what, Which) {
  const auto column = [&](const char* name, const char* unit, const std::string& meaning, auto get) {
    return computed<RunRow>(group + "_" + name, group + "/" + name, unit, meaning, get);
  };
  return {column("psnr_db", "dB", what + ": PSNR of the mean squared error; null: identical",
                 [](const RunRow& r) { return Which{}(r)->psnr_db(); }),
          column("ssim", "", what + ": structural similarity, mean over the frames",
                 [](const RunRow& r) { return Which{}(r)->ssim; }),
          column("flip", "", what + ": FLIP, mean over the frames",
                 [](const RunRow& r) { return Which{}(r)->flip; })};
}

std::vector<ColumnGroup<RunRow>> run_groups() {
  return {
      {"visibility", "where layers were sorted in any frame; null: the groups alone gave the order", true,
       [](const RunRow& r) { return r.visibility.frames > 0; }},
      {"compression", "with --compression", false, [](const RunRow& r) { return r.compression.has_value(); }},
      {"lookahead", "with --policy lookahead or oracle", false,
       [](const RunRow& r) { return r.sums.lookahead().has_value(); }},
      {"predictive", "with --policy predictive", false,
       [](const RunRow& r) { return r.sums.surprises().has_value(); }},
      {"budget_gap", "with --budget-gap", false, [](const RunRow& r) { return r.gap.frames > 0; }},
      {"latency", "with --latency-ms", false, [](const RunRow& r) { return r.sums.latency().frames > 0; }},
      {"lod", "with --lod optimise", false, [](const RunRow& r) { return r.sums.lod().frames > 0; }},
      {"quality", "with --quality", false, [](const RunRow& r) { return r.quality.has_value(); }},
      {"quality_of_reuse", "with --quality", false,
       [](const RunRow& r) { return r.quality_of_reuse.has_value(); }},
      {"quality_of_resampling", "with --quality", false,
       [](const RunRow& r) { return r.quality_of_resampling.has_value(); }}};
}

}  // namespace

RunRow::RunRow(const Summary& s)
    : summary(s), sums(s.sums()), visibility(sums.visibility()), resolved(sums.resolved()), gap(sums.gap()) {
  if (s.compression_quality && !s.planned_only)
    compression = sums.compression().value_or(CompressionReport{});
  quality = sums.quality(&FrameQuality::total);
  quality_of_reuse = sums.quality(&FrameQuality::reuse);
  quality_of_resampling = sums.quality(&FrameQuality::resampling);
}

const ColumnTable<RunRow>& run_table() {
  static const ColumnTable<RunRow> table = [] {
    ColumnTable<RunRow> t{"run", "talisman.summary/1", {}, run_groups()};
    for (const RunColumns& part :
         {what_was_run(), run_work(), run_visibility(), modelled(), compression(), run_motion_ahead(),
          run_budget_gap(), run_levels(), run_latency(),
          run_quality(
              "quality", "displayed against `direct`", [](auto& r) -> auto& { return r.quality; }),
          run_quality(
              "quality_of_reuse", "displayed against `reference`",
              [](auto& r) -> auto& { return r.quality_of_reuse; }),
          run_quality(
              "quality_of_resampling", "`reference` against `direct`",
              [](auto& r) -> auto& { return r.quality_of_resampling; })})
      t.columns.insert(t.columns.end(), part.begin(), part.end());
    return t;
  }();
  return table;
}

}  // namespace talisman::sequences
