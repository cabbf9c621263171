// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/column_tables.h"
#include "sequences/results/shared_columns.h"

namespace talisman::sequences {

namespace {

using FrameColumns = std::vector<Column<FrameLine>>;

/// A member that is known only of frames that were drawn; else null.
template <typename Member>
Column<FrameLine> measured(std::string name, std::string unit, std::string meaning, Member member) {
  const std::string path = name;
  Column<FrameLine> column =
      stored<FrameLine>(std::move(name), path, std::move(unit), std::move(meaning), member);
  column.get = [](const FrameLine& line) {
    return line.is_drawn() ? value_of(Member{}(line)) : Value(Null{});
  };
  return column;
}

template <typename Member>
Column<FrameLine> counted(std::string name, std::string unit, std::string meaning, Member member) {
  const std::string path = name;
  return stored<FrameLine>(std::move(name), path, std::move(unit), std::move(meaning), member);
}

FrameColumns counters() {
  return {counted(
              "frame", "", "number of the frame, from 0", [](auto& l) -> auto& { return l.frame; }),
          measured(
              "frame_hash", "", "XXH3-128 of the linear picture, hexadecimal; null: not drawn",
              [](auto& l) -> auto& { return l.frame_hash; }),
          counted(
              "layers_in_view", "layers", "that have a sprite in this frame",
              [](auto& l) -> auto& { return l.layers_in_view; }),
          counted(
              "renders", "layers", "of them, drawn anew", [](auto& l) -> auto& { return l.renders; }),
          counted(
              "reuses", "layers", "of them, shown by their old sprite",
              [](auto& l) -> auto& { return l.reuses; }),
          counted(
              "layers_assessed", "layers", "in view with an old sprite: fitted and judged",
              [](auto& l) -> auto& { return l.layers_assessed; }),
          counted(
              "mean_geometric_px", "px", "geometric_px of the layers in view, their mean",
              [](auto& l) -> auto& { return l.error.mean_px; }),
          counted(
              "mean_geometric_px_by_pixels", "px",
              "the same, each layer weighted by the pixels of the display that its sprite covers",
              [](auto& l) -> auto& { return l.error.mean_by_pixels_px; })};
}

FrameColumns frame_work() {
  return {counted(
              "shadow_maps_drawn", "maps", "as planned",
              [](auto& l) -> auto& { return l.passes.shadow_maps_drawn; }),
          counted(
              "shadow_maps_reused", "maps", "looked up as they were, as planned",
              [](auto& l) -> auto& { return l.passes.shadow_maps_reused; }),
          counted(
              "reflections_drawn", "pictures", "of what mirrors show, as planned",
              [](auto& l) -> auto& { return l.passes.reflections_drawn; }),
          counted(
              "polygons_rendered", "triangles", "of the layers rendered, and of casters in shadow maps",
              [](auto& l) -> auto& { return l.polygons.rendered; }),
          counted(
              "polygons_reference", "triangles",
              "what `reference` would draw: all layers in view, and the shadow maps that changed",
              [](auto& l) -> auto& { return l.polygons.reference; }),
          counted(
              "pixels_rendered", "texels",
              "of the rectangles of the sprites rendered, of mirrored pictures, of shadow maps and of "
              "sprites that "
              "are mixed of an old one and a fresh one",
              [](auto& l) -> auto& { return l.pixels.rendered; }),
          counted(
              "pixels_reference", "texels", "what `reference` would draw",
              [](auto& l) -> auto& { return l.pixels.reference; })};
}

FrameColumns drawing() {
  return {
      measured(
          "pixels_filled", "texels", "writes by the renderer, texels of shadow maps and of mixed sprites",
          [](auto& l) -> auto& { return l.pixels.filled; }),
      measured(
          "pixels_composited", "pixels", "reads of sprites by the compositor",
          [](auto& l) -> auto& { return l.pixels.composited; }),
      measured(
          "pixels_in_registers", "pixels", "written by the operators of compositing expressions",
          [](auto& l) -> auto& { return l.pixels.registers; }),
      measured(
          "chunks_rendered", "32×32 chunks", "in which something was drawn",
          [](auto& l) -> auto& { return l.chunks.rendered; }),
      measured(
          "chunks_clear", "32×32 chunks", "of the sprites rendered, in which nothing was",
          [](auto& l) -> auto& { return l.chunks.clear; }),
      measured(
          "fragments", "fragments", "stored for pixels that are covered in part, or translucent",
          [](auto& l) -> auto& { return l.fragments; }),
      measured(
          "texture_samples", "samples", "filtered look-ups, trilinear or bilinear",
          [](auto& l) -> auto& { return l.texture_samples; }),
      measured(
          "sprite_bytes", "bytes", "of the sprites that the frame shows, as they are stored",
          [](auto& l) -> auto& { return l.sprite_bytes; }),
      measured(
          "modelled_ms", "ms", "modelled time of the frame on the profile talisman-1996",
          [](auto& l) -> auto& { return l.modelled_ms; }),
      counted(
          "modelled_drawing_ms", "ms",
          "of it the renderer's part, as planned: texels are filled depth_complexity times",
          [](auto& l) -> auto& { return l.modelled_drawing_ms; }),
      counted(
          "depth_complexity", "", "how often a texel is filled, as measured for a budget of ms; at least 1",
          [](auto& l) -> auto& { return l.depth_complexity; })};
}

template <typename Member>
Column<FrameLine> sorting(const char* name, const char* unit, const char* meaning, Member member) {
  return stored<FrameLine>(std::string("visibility_") + name, std::string("visibility/") + name, unit,
                           meaning, member);
}

FrameColumns frame_visibility() {
  return {sorting(
              "layers", "layers", "that were sorted",
              [](auto& l) -> auto& { return l.visibility->counters.layers; }),
          sorting(
              "queries", "bodies", "whose possible occluders were looked up",
              [](auto& l) -> auto& { return l.visibility->counters.queries; }),
          sorting(
              "pairs", "pairs", "of bodies that extents cannot tell apart in view",
              [](auto& l) -> auto& { return l.visibility->counters.pairs; }),
          sorting(
              "exact_tests", "pairs", "of these, tested on the hulls",
              [](auto& l) -> auto& { return l.visibility->counters.exact_tests; }),
          sorting(
              "edges", "pairs", "of bodies of which one can occlude the other",
              [](auto& l) -> auto& { return l.visibility->counters.edges; }),
          sorting(
              "swaps", "layers", "that moved within last frame's line",
              [](auto& l) -> auto& { return l.visibility->counters.swaps; }),
          sorting(
              "components", "components", "single layers and cycles together",
              [](auto& l) -> auto& { return l.visibility->counters.components; }),
          sorting(
              "merged_components", "components", "cycles that share a sprite",
              [](auto& l) -> auto& { return l.visibility->counters.merged_components; }),
          sorting(
              "merged_layers", "layers", "in these",
              [](auto& l) -> auto& { return l.visibility->counters.merged_layers; })};
}

/// Compositing expressions, and the sprites that are merged all the same.
FrameColumns frame_expressions() {
  return {sorting(
              "resolved_components", "components", "cycles that an expression of the compositor shows",
              [](auto& l) -> auto& { return l.visibility->resolved.components; }),
          sorting(
              "resolved_layers", "layers", "in these",
              [](auto& l) -> auto& { return l.visibility->resolved.layers; }),
          sorting(
              "expression_registers", "registers", "images that one expression keeps at once, at most",
              [](auto& l) -> auto& { return l.visibility->resolved.registers; }),
          sorting(
              "expression_operators", "operators", "evaluated by the expressions, each over an image",
              [](auto& l) -> auto& { return l.visibility->resolved.operators; }),
          sorting(
              "expression_reads", "reads", "of sprites by the expressions",
              [](auto& l) -> auto& { return l.visibility->resolved.reads; }),
          sorting(
              "merged_parts", "parts", "of all merged sprites together",
              [](auto& l) -> auto& { return l.visibility->merged_parts; })};
}

FrameColumns frame_budget_gap() {
  return {stored<FrameLine>(
              "budget_gap_greedy_px", "budget_gap/greedy_px", "px", "benefit of the layers chosen",
              [](auto& l) -> auto& { return l.budget_gap->greedy_px; }),
          stored<FrameLine>(
              "budget_gap_optimal_px", "budget_gap/optimal_px", "px", "of the best choice",
              [](auto& l) -> auto& { return l.budget_gap->optimal_px; }),
          computed<FrameLine>("budget_gap", "budget_gap/gap", "", "share of the best that was missed, 0 to 1",
                              [](const FrameLine& l) { return l.budget_gap->gap(); }),
          stored<FrameLine>(
              "budget_gap_exact", "budget_gap/exact", "", "the best was proved to be that",
              [](auto& l) -> auto& { return l.budget_gap->exact; })};
}

FrameColumns frame_levels() {
  return {stored<FrameLine>(
              "lod_benefit", "lod/benefit", "", "of what was chosen; with --benefit error in pixels",
              [](auto& l) -> auto& { return l.lod->benefit; }),
          stored<FrameLine>(
              "lod_upper_bound", "lod/upper_bound", "", "no choice within the budget has more benefit",
              [](auto& l) -> auto& { return l.lod->upper_bound; }),
          stored<FrameLine>(
              "lod_cost_ms", "lod/cost_ms", "ms", "modelled time of what was chosen, each layer alone",
              [](auto& l) -> auto& { return l.lod->cost_ms; }),
          stored<FrameLine>(
              "lod_fits", "lod/fits", "",
              "false: the coarsest pictures of what comes into view exceed the budget",
              [](auto& l) -> auto& { return l.lod->fits; }),
          stored<FrameLine>(
              "lod_skipped", "lod/skipped", "layers", "in view and not shown",
              [](auto& l) -> auto& { return l.lod->skipped; })};
}

FrameColumns written_pictures() {
  return {stored<FrameLine>(
      "picture_hash", "written/picture_hash", "",
      "XXH3-128 of the picture's file, hexadecimal; with --separate: of that and of the files of the frame "
      "there",
      [](auto& l) -> auto& { return l.picture_hash; })};
}

FrameColumns frame_predictive() {
  return {
      stored<FrameLine>(
          "predictive_slice", "predictive/slice", "frame", "first frame of the slice",
          [](auto& l) -> auto& { return l.predictive->slice_first; }),
      stored<FrameLine>(
          "predictive_slice_frames", "predictive/slice_frames", "frames", "for which it is planned",
          [](auto& l) -> auto& { return l.predictive->slice_frames; }),
      stored<FrameLine>(
          "predictive_surprises", "predictive/surprises", "",
          "1: something was not where it was expected; the plan was dropped, and all is drawn",
          [](auto& l) -> auto& { return l.predictive->surprises; }),
      stored<FrameLine>(
          "predictive_surprised", "predictive/surprised", "parts", "that were not where they were expected",
          [](auto& l) -> auto& { return l.predictive->surprised; }),
      stored<FrameLine>(
          "predictive_parts", "predictive/parts", "parts", "that the scene shows",
          [](auto& l) -> auto& { return l.predictive->parts; }),
      stored<FrameLine>(
          "predictive_parts_drawn", "predictive/parts_drawn", "parts", "of these, drawn for this frame",
          [](auto& l) -> auto& { return l.predictive->parts_drawn; }),
      stored<FrameLine>(
          "predictive_joins", "predictive/joins", "", "of two buffers that the plan has for this frame",
          [](auto& l) -> auto& { return l.predictive->joins_planned; }),
      stored<FrameLine>(
          "predictive_joins_empty", "predictive/joins_empty", "",
          "of these, with a buffer into which nothing is drawn",
          [](auto& l) -> auto& { return l.predictive->joins_without_content; }),
      stored<FrameLine>(
          "prediction_vertices", "predictive/vertices", "",
          "of prediction primitives, projected for the slice: in its first frame",
          [](auto& l) -> auto& { return l.predictive->prediction_vertices; }),
      stored<FrameLine>(
          "predictive_edge_pixels", "predictive/edge_pixels", "pixels",
          "displayed and covered in part, when drawn with more than one sample: a join shows the background "
          "through them where something is behind",
          [](auto& l) -> auto& { return l.predictive->edge_pixels; })};
}

FrameColumns frame_lookahead() {
  return {
      stored<FrameLine>(
          "lookahead_judged", "lookahead/judged", "",
          "pairs of an instant ahead and a frame that were judged: would the one's sprite serve the other?",
          [](auto& l) -> auto& { return l.lookahead->judged; }),
      stored<FrameLine>(
          "lookahead_evaluated", "lookahead/evaluated", "",
          "of these, by fit and fiducials: neither rest nor a bound of the error was certain",
          [](auto& l) -> auto& { return l.lookahead->evaluated; })};
}

FrameColumns frame_latency() {
  const auto column = [](const char* name, const char* unit, const char* meaning, auto member) {
    return stored<FrameLine>(std::string("latency_") + name, std::string("latency/") + name, unit, meaning,
                             member);
  };
  return {
      column(
          "drawn_turn_deg", "°", "between the camera that decisions and sprites know and the true one",
          [](auto& l) -> auto& { return l.latency->drawn_turn_deg; }),
      column(
          "shown_turn_deg", "°", "of the camera that the last warp knows, likewise",
          [](auto& l) -> auto& { return l.latency->shown_turn_deg; }),
      column(
          "drawn_moved_m", "m", "between the places of the first two",
          [](auto& l) -> auto& { return l.latency->drawn_moved_m; }),
      column(
          "shown_moved_m", "m", "of the camera of the last warp, likewise",
          [](auto& l) -> auto& { return l.latency->shown_moved_m; }),
      column(
          "true_px", "px", "largest true_px of a layer", [](auto& l) -> auto& { return l.latency->true_px; }),
      column(
          "true_mean_px", "px", "mean over the layers that are shown",
          [](auto& l) -> auto& { return l.latency->true_mean_px; }),
      column(
          "layers_missing", "layers", "that the true camera sees and the frame does not show",
          [](auto& l) -> auto& { return l.latency->layers_missing; })};
}

FrameColumns frame_refresh() {
  return {stored<FrameLine>(
              "refreshed_layers", "refresh/layers", "layers", "chunks of which were drawn alone",
              [](auto& l) -> auto& { return l.refresh->layers; }),
          stored<FrameLine>(
              "refreshed_chunks", "refresh/chunks", "32×32 chunks", "that were",
              [](auto& l) -> auto& { return l.refresh->chunks; }),
          stored<FrameLine>(
              "refresh_step_px", "refresh/step_px", "px",
              "bound of the step between chunks of different age that are shown beside each other, at most",
              [](auto& l) -> auto& { return l.refresh->step_px; }),
          stored<FrameLine>(
              "refresh_torn_borders", "refresh/torn_borders", "groups of triangles",
              "at such borders, whose step may be more than geometric_px: an outline there may be lost or "
              "doubled",
              [](auto& l) -> auto& { return l.refresh->torn_borders; })};
}

FrameColumns light_layers() {
  return {stored<FrameLine>(
      "light_beside_px", "light_layers/beside_px", "px",
      "how far the light of a light layer falls beside its surface: the largest of all; at most "
      "the sum of the geometric errors of both",
      [](auto& l) -> auto& { return *l.light_beside_px; })};
}

FrameColumns moving_pictures() {
  return {stored<FrameLine>(
      "upload_bytes", "moving_pictures/upload_bytes", "bytes",
      "of frames of image sequences and videos that are drawn for the first time since another one was",
      [](auto& l) -> auto& { return *l.upload_bytes; })};
}

FrameColumns seams() {
  return {stored<FrameLine>(
      "open_seam_pixels", "seams/open_px", "pixels",
      "at the edges that layers share, where what is behind them shows: alpha more than 8/255 below "
      "`direct`'s; without the border of the display, where `uncovered_px` rules",
      [](auto& l) -> auto& { return *l.open_seam_pixels; })};
}

/// One comparison of pictures. `Which` returns a Quality by reference.
template <typename Which>
FrameColumns quality(const std::string& which, const std::string& what, Which) {
  const auto column = [&](const char* name, const char* unit, const std::string& meaning, auto member) {
    return stored<FrameLine>("quality_" + which + "_" + name, "quality/" + which + "/" + name, unit, meaning,
                             member);
  };
  return {column(
              "psnr_db", "dB", what + ": PSNR; null: identical",
              [](auto& l) -> auto& { return Which{}(l).psnr_db; }),
          column(
              "ssim", "", what + ": structural similarity, at most 1",
              [](auto& l) -> auto& { return Which{}(l).ssim; }),
          column(
              "flip", "", what + ": FLIP, 0 to 1", [](auto& l) -> auto& { return Which{}(l).flip; }),
          column(
              "max_difference", "code values", what + ": largest of a channel",
              [](auto& l) -> auto& { return Which{}(l).max_difference; }),
          column(
              "changed_pixels", "", what + ": share of pixels that differ",
              [](auto& l) -> auto& { return Which{}(l).changed_pixels; })};
}

void make_quality(FrameLine& line) {
  line.quality.emplace();
  for (Quality* q : {&line.quality->total, &line.quality->reuse, &line.quality->resampling})
    q->psnr_db = INFINITY;  // null when read
}

std::vector<ColumnGroup<FrameLine>> frame_groups() {
  return {
      {"compression", "with --compression", false,
       [](const FrameLine& l) { return l.compression.has_value(); },
       [](FrameLine& l) { l.compression.emplace(); }},
      {"visibility", "where layers were sorted; null: the groups alone gave the order", true,
       [](const FrameLine& l) { return l.visibility.has_value(); },
       [](FrameLine& l) { l.visibility.emplace(); }},
      {"written", "where the picture was written to a file", false,
       [](const FrameLine& l) { return !l.picture_hash.empty(); }},
      {"light_layers", "where layers hold the light of single lights", false,
       [](const FrameLine& l) { return l.light_beside_px.has_value(); },
       [](FrameLine& l) { l.light_beside_px = 0; }},
      {"seams", "with --quality, where layers share edges", false,
       [](const FrameLine& l) { return l.open_seam_pixels.has_value(); },
       [](FrameLine& l) { l.open_seam_pixels = 0; }},
      {"moving_pictures", "where the scene has image sequences or videos", false,
       [](const FrameLine& l) { return l.upload_bytes.has_value(); },
       [](FrameLine& l) { l.upload_bytes = 0; }},
      {"lookahead", "with --policy lookahead or oracle", false,
       [](const FrameLine& l) { return l.lookahead.has_value(); },
       [](FrameLine& l) { l.lookahead.emplace(); }},
      {"predictive", "with --policy predictive", false,
       [](const FrameLine& l) { return l.predictive.has_value(); },
       [](FrameLine& l) { l.predictive.emplace(); }},
      {"refresh", "with --refresh chunks", false, [](const FrameLine& l) { return l.refresh.has_value(); },
       [](FrameLine& l) { l.refresh.emplace(); }},
      {"latency", "with --latency-ms", false, [](const FrameLine& l) { return l.latency.has_value(); },
       [](FrameLine& l) { l.latency.emplace(); }},
      {"budget_gap", "with --budget-gap", false, [](const FrameLine& l) { return l.budget_gap.has_value(); },
       [](FrameLine& l) { l.budget_gap.emplace(); }},
      {"lod", "with --lod optimise", false, [](const FrameLine& l) { return l.lod.has_value(); },
       [](FrameLine& l) { l.lod.emplace(); }},
      {"quality", "with --quality", false, [](const FrameLine& l) { return l.quality.has_value(); },
       make_quality}};
}

}  // namespace

const ColumnTable<FrameLine>& frame_table() {
  static const ColumnTable<FrameLine> table = [] {
    ColumnTable<FrameLine> t{"frames", "talisman.frame/1", {}, frame_groups()};
    for (const FrameColumns& part :
         {counters(), frame_work(), drawing(),
          compression_columns<FrameLine>([](auto& l) -> auto& { return *l.compression; }), frame_visibility(),
          written_pictures(), light_layers(), moving_pictures(), seams(), frame_expressions(),
          frame_budget_gap(), frame_levels(), frame_lookahead(), frame_predictive(), frame_refresh(),
          frame_latency(),
          quality(
              "total", "displayed against `direct`", [](auto& l) -> auto& { return l.quality->total; }),
          quality(
              "reuse", "displayed against `reference`", [](auto& l) -> auto& { return l.quality->reuse; }),
          quality(
              "resampling", "`reference` against `direct`",
              [](auto& l) -> auto& { return l.quality->resampling; })})
      t.columns.insert(t.columns.end(), part.begin(), part.end());
    return t;
  }();
  return table;
}

}  // namespace talisman::sequences
