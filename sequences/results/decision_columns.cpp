// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/aggregates.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

using Row = DecisionRow;
using DecisionColumns = std::vector<Column<Row>>;

const regulator::LayerAssessment& assessment(const Row& row) { return row.assessment; }
const fiducials::Report& fiducials_of(const Row& row) { return assessment(row).fiducials; }

/// `value` of the photometric fiducial where it was computed; else there is only the reason.
template <typename T>
Value photometric(const Row& row, T fiducials::Photometric::*value) {
  const fiducials::Photometric& p = fiducials_of(row).photometric;
  return p.computed ? value_of(p.*value) : Value(Absent{});
}

template <int axis>
Value multiplier(const Row& row) {
  const fiducials::Photometric& p = fiducials_of(row).photometric;
  return p.computed ? value_of(p.multiplier[axis]) : Value(Absent{});
}

template <int axis>
Value photometric_place(const Row& row) {
  const fiducials::Photometric& p = fiducials_of(row).photometric;
  return p.computed ? value_of(p.where_px[axis]) : Value(Absent{});
}

Value light(const Row& row, fiducials::LightRef fiducials::Photometric::*which) {
  const fiducials::Photometric& p = fiducials_of(row).photometric;
  if (!p.computed) return Absent{};
  const fiducials::LightRef& light = p.*which;
  if (light.index == fiducials::LightRef::kEye) return value_of("eye (highlights)");
  return light.index >= 0 ? value_of(std::string_view(light.name)) : Value(Null{});
}

/// The entry of the warp's matrix; the last row is there for perspective warps alone.
template <int row_of_matrix, int column>
Value entry_of_warp(const Row& row) {
  const warp::Warp& w = row.decision.shown_warp;
  if (row_of_matrix == 2 && w.is_affine()) return Absent{};
  return value_of(w.now_from_then[column][row_of_matrix]);
}

/// A fiducial that may be left out: null where it was not computed.
template <typename Part, typename T>
Value if_computed(const Part& part, T value) {
  return part.computed ? value_of(value) : Value(Null{});
}

DecisionColumns what_was_done() {
  return {
      computed<Row>("frame", "frame", "", "number of the frame, from 0",
                    [](const Row& r) { return r.frame; }),
      computed<Row>("layer", "layer", "",
                    "name of the layer, of the aggregate that draws several, or of the shadow map",
                    [](const Row& r) { return std::string_view(r.name); }),
      computed<Row>(
          "decision", "decision", "",
          "reuse (warp the old sprite), rerender, refresh (warp it, and draw some of its chunks), or drop "
          "(out of view)",
          [](const Row& r) { return regulator::name(r.decision.action); }),
      computed<Row>("reason", "reason", "",
                    "why, with the numbers that decided; settled: it was shown enlarged, and is at rest",
                    [](const Row& r) { return r.decision.reason; })};
}

DecisionColumns warp_columns() {
  const char* place = "the map of sprite positions when drawn to display positions now, row by row";
  return {
      computed<Row>("warp_xx", "warp/0", "", place, [](const Row& r) { return entry_of_warp<0, 0>(r); }),
      computed<Row>("warp_xy", "warp/1", "", "likewise", [](const Row& r) { return entry_of_warp<0, 1>(r); }),
      computed<Row>("warp_x", "warp/2", "px", "likewise",
                    [](const Row& r) { return entry_of_warp<0, 2>(r); }),
      computed<Row>("warp_yx", "warp/3", "", "likewise", [](const Row& r) { return entry_of_warp<1, 0>(r); }),
      computed<Row>("warp_yy", "warp/4", "", "likewise", [](const Row& r) { return entry_of_warp<1, 1>(r); }),
      computed<Row>("warp_y", "warp/5", "px", "likewise",
                    [](const Row& r) { return entry_of_warp<1, 2>(r); }),
      computed<Row>("warp_wx", "warp/6", "1/px", "third row; only of perspective warps",
                    [](const Row& r) { return entry_of_warp<2, 0>(r); }),
      computed<Row>("warp_wy", "warp/7", "1/px", "likewise",
                    [](const Row& r) { return entry_of_warp<2, 1>(r); }),
      computed<Row>("warp_w", "warp/8", "", "likewise", [](const Row& r) { return entry_of_warp<2, 2>(r); })};
}

template <int entry>
Value entry_of_placement(const Row& row) {
  const layers::dmat3 map = layers::to_mat3(row.placement->screen_from_sprite);
  return value_of(map[entry % 3][entry / 3]);
}

/// Where the sprite was when it was drawn. With the warp: where it is shown.
DecisionColumns placement_columns() {
  const char* place = "the map of texels to display positions when the sprite was drawn, row by row";
  return {computed<Row>("sprite_xx", "sprite/screen_from_sprite/0", "px", place,
                        [](const Row& r) { return entry_of_placement<0>(r); }),
          computed<Row>("sprite_xy", "sprite/screen_from_sprite/1", "px", "likewise",
                        [](const Row& r) { return entry_of_placement<1>(r); }),
          computed<Row>("sprite_x", "sprite/screen_from_sprite/2", "px", "likewise",
                        [](const Row& r) { return entry_of_placement<2>(r); }),
          computed<Row>("sprite_yx", "sprite/screen_from_sprite/3", "px", "likewise",
                        [](const Row& r) { return entry_of_placement<3>(r); }),
          computed<Row>("sprite_yy", "sprite/screen_from_sprite/4", "px", "likewise",
                        [](const Row& r) { return entry_of_placement<4>(r); }),
          computed<Row>("sprite_y", "sprite/screen_from_sprite/5", "px", "likewise",
                        [](const Row& r) { return entry_of_placement<5>(r); }),
          computed<Row>("sprite_width", "sprite/size/0", "texels", "of the sprite shown",
                        [](const Row& r) { return r.placement->size_px.x; }),
          computed<Row>("sprite_height", "sprite/size/1", "texels", "likewise",
                        [](const Row& r) { return r.placement->size_px.y; })};
}

DecisionColumns what_is_shown() {
  return {
      computed<Row>(
          "geometric_px", "geometric_px", "px",
          "error of what is displayed: largest distance of a characteristic point from where it "
          "belongs; 0 for a fresh sprite, unless its shadow map is old: then how far its shadow is off; "
          "of a shadow map: how far its shadows have run since it was drawn, where that is judged",
          [](const Row& r) { return r.decision.shown_geometric_px; }),
      computed<Row>("color_r", "color/0", "",
                    "multiplier of the sprite's colour, 0 to 1; 1 for a fresh sprite",
                    [](const Row& r) { return r.decision.shown_color.x; }),
      computed<Row>("color_g", "color/1", "", "likewise",
                    [](const Row& r) { return r.decision.shown_color.y; }),
      computed<Row>("color_b", "color/2", "", "likewise",
                    [](const Row& r) { return r.decision.shown_color.z; }),
      computed<Row>("resolution", "resolution", "",
                    "of the sprite shown, relative to what the layer's author asks for",
                    [](const Row& r) { return r.decision.resolution; }),
      computed<Row>("depicts_frame", "depicts_frame", "",
                    "the frame as of which the sprite was drawn; null: nothing is shown", [](const Row& r) {
                      const int frame = r.decision.depicts_frame;
                      return frame >= 0 ? value_of(frame) : Value(Null{});
                    })};
}

/// Absent where no pose is old.
DecisionColumns late_columns() {
  return {computed<Row>(
      "true_px", "true_px", "px",
      "with --latency-ms: largest distance of a characteristic point, as it is shown, from where "
      "the true camera sees it; null: none is in both views",
      [](const Row& r) {
        if (r.late == nullptr) return Value(Absent{});
        const double px = r.late->layer_px[r.decision.layer];
        return px < 0 ? Value(Null{}) : value_of(px);
      })};
}

/// Absent where levels are not chosen.
DecisionColumns level_columns() {
  return {
      computed<Row>("level", "level", "",
                    "with --lod: level of detail of the sprite shown, 0 is the finest; of several parts with "
                    "optimise: rung of allowed errors; absent out of view",
                    [](const Row& r) {
                      return assessment(r).levels.empty() ? Value(Absent{}) : value_of(r.decision.level);
                    }),
      computed<Row>("skipped", "skipped", "",
                    "with --lod: true where the layer is in view and not shown: the budget did not suffice",
                    [](const Row& r) { return r.decision.skipped ? value_of(true) : Value(Absent{}); })};
}

DecisionColumns geometric_columns() {
  return {
      computed<Row>(
          "warp_geometric_px", "fiducials/warp_geometric_px", "px",
          "error that the old sprite would have with the warp, also when that was rejected; `shade_px` is "
          "part of it",
          [](const Row& r) { return fiducials_of(r).geometric.px; }),
      computed<Row>("geometric_weight", "fiducials/geometric_weight", "",
                    "the layer's importance of that error: its threshold is `geometric_px` of the settings "
                    "divided by it",
                    [](const Row& r) { return assessment(r).preferences.importance.geometric; }),
      computed<Row>("held_geometric_px", "fiducials/held_geometric_px", "px",
                    "error that the old sprite would have where it was, without a warp",
                    [](const Row& r) { return assessment(r).held_geometric_px; }),
      computed<Row>(
          "worst_at_x_px", "fiducials/worst_at_px/0", "px",
          "where the geometric error is largest; the nearest place on the display where that lies beyond "
          "its edge",
          [](const Row& r) { return fiducials_of(r).geometric.where_px.x; }),
      computed<Row>("worst_at_y_px", "fiducials/worst_at_px/1", "px", "likewise",
                    [](const Row& r) { return fiducials_of(r).geometric.where_px.y; }),
      computed<Row>("magnification", "fiducials/magnification", "",
                    "most by which the warp stretches a texel; 1 at rest",
                    [](const Row& r) { return fiducials_of(r).sampling.magnification; }),
      computed<Row>("minification", "fiducials/minification", "",
                    "least by which it stretches one; below 1 texels are squeezed",
                    [](const Row& r) { return fiducials_of(r).sampling.minification; }),
      computed<Row>("anisotropy", "fiducials/anisotropy", "", "largest ratio of the two at one place",
                    [](const Row& r) { return fiducials_of(r).sampling.anisotropy; }),
      computed<Row>("uncovered_px", "fiducials/uncovered_px", "px",
                    "depth to which a side cut off by the display has come into view; null: not computed",
                    [](const Row& r) {
                      const auto& v = fiducials_of(r).visibility;
                      return if_computed(v, v.uncovered_px);
                    }),
      computed<Row>("uncovered_why_not", "fiducials/uncovered_why_not", "",
                    "why that was not computed; empty if it was",
                    [](const Row& r) { return std::string_view(fiducials_of(r).visibility.why_not); })};
}

DecisionColumns photometric_columns() {
  using P = fiducials::Photometric;
  return {
      computed<Row>("photometric_why_not", "fiducials/photometric/why_not", "",
                    "why the photometric fiducial was not computed; absent if it was",
                    [](const Row& r) {
                      const P& p = fiducials_of(r).photometric;
                      return p.computed ? Value(Absent{}) : value_of(std::string_view(p.why_not));
                    }),
      computed<Row>("photometric_color", "fiducials/photometric/color", "",
                    "largest error of the shading after the colour warp, linear light, 1 is white",
                    [](const Row& r) { return photometric(r, &P::color); }),
      computed<Row>("photometric_multiplier_r", "fiducials/photometric/multiplier/0", "",
                    "the colour warp that fits best", [](const Row& r) { return multiplier<0>(r); }),
      computed<Row>("photometric_multiplier_g", "fiducials/photometric/multiplier/1", "", "likewise",
                    [](const Row& r) { return multiplier<1>(r); }),
      computed<Row>("photometric_multiplier_b", "fiducials/photometric/multiplier/2", "", "likewise",
                    [](const Row& r) { return multiplier<2>(r); }),
      computed<Row>("photometric_worst_at_x_px", "fiducials/photometric/worst_at_px/0", "px",
                    "where on the display the shading is most wrong",
                    [](const Row& r) { return photometric_place<0>(r); }),
      computed<Row>("photometric_worst_at_y_px", "fiducials/photometric/worst_at_px/1", "px", "likewise",
                    [](const Row& r) { return photometric_place<1>(r); }),
      computed<Row>("photometric_light", "fiducials/photometric/light", "",
                    "the light that changed most at that place; null: none",
                    [](const Row& r) { return light(r, &P::color_light); }),
      computed<Row>("light_angle_rad", "fiducials/photometric/light_angle_rad", "rad",
                    "largest angle by which a light, or for highlights the eye, has moved about the layer",
                    [](const Row& r) { return photometric(r, &P::light_angle_rad); }),
      computed<Row>("light_angle_light", "fiducials/photometric/angle_light", "", "that light; null: none",
                    [](const Row& r) { return light(r, &P::angle_light); }),
      computed<Row>("light_distance", "fiducials/photometric/light_distance", "",
                    "largest change of a light's distance, relative to the larger one, 0 to 1",
                    [](const Row& r) { return photometric(r, &P::light_distance); })};
}

DecisionColumns remaining_fiducials() {
  return {
      computed<Row>(
          "turned_px", "fiducials/turned_px", "px",
          "square root of the largest area of a side that has turned to the eye; null: not computed",
          [](const Row& r) {
            const auto& t = fiducials_of(r).turned;
            return if_computed(t, t.px);
          }),
      computed<Row>("turned_faces", "fiducials/turned_faces", "faces",
                    "how many sides have turned to the eye",
                    [](const Row& r) { return fiducials_of(r).turned.count; }),
      computed<Row>("shade_px", "fiducials/shade_px", "px",
                    "how far shadows, highlights and mirrored pictures have run over the surface; null: not "
                    "computed",
                    [](const Row& r) {
                      const auto& s = fiducials_of(r).shade;
                      return if_computed(s, s.px);
                    }),
      computed<Row>("matched_points", "fiducials/matched_points", "points",
                    "characteristic points that the warp was fitted to",
                    [](const Row& r) { return assessment(r).matched_points; }),
      computed<Row>("fit", "fiducials/fit", "", "status of the fit",
                    [](const Row& r) { return warp::name(assessment(r).fitted.status); }),
      computed<Row>("frames_since_render", "fiducials/frames_since_render", "frames", "age of the old sprite",
                    [](const Row& r) { return assessment(r).frames_since_render; })};
}

DecisionColumns chunk_columns() {
  return {computed<Row>("chunks_drawn", "chunks/drawn", "32×32 chunks", "of the old sprite, drawn anew",
                        [](const Row& r) { return r.decision.chunks->drawn; }),
          computed<Row>("chunks_stored", "chunks/stored", "32×32 chunks",
                        "of it, that may hold something by the layer's geometry",
                        [](const Row& r) { return r.decision.chunks->stored; }),
          computed<Row>("chunks_step_px", "chunks/step_px", "px",
                        "bound of the step between chunks of different age that are shown beside each other",
                        [](const Row& r) { return r.decision.chunks->step_px; }),
          computed<Row>("chunks_torn_borders", "chunks/torn_borders", "groups of triangles",
                        "at such borders, whose step may be more than geometric_px",
                        [](const Row& r) { return r.decision.chunks->torn_borders; })};
}

DecisionColumns cost_columns() {
  return {
      computed<Row>("cost_polygons", "cost/polygons", "triangles", "sent to the renderer; 0 unless rendered",
                    [](const Row& r) { return r.decision.cost.polygons; }),
      computed<Row>("cost_pixels", "cost/pixels", "texels",
                    "of the sprite's rectangle, of mirrored pictures, of the map; likewise",
                    [](const Row& r) { return r.decision.cost.pixels; }),
      computed<Row>("cost_chunks", "cost/chunks", "32×32 chunks",
                    "of the sprite's rectangle, of mirrored pictures, of the map; likewise",
                    [](const Row& r) { return r.decision.cost.chunks; }),
      computed<Row>("cost_bytes", "cost/bytes", "bytes",
                    "of the sprite, uncompressed, clear chunks included, likewise",
                    [](const Row& r) { return r.decision.cost.bytes; })};
}

/// Null where nothing is shown.
const layers::SpritePlacement* placement_shown(const PipelineState& state, const FrameReport& report,
                                               int layer) {
  const layers::SpritePlacement& placement = state.memory[layer].placement;
  const bool is_shown = report.plan.decisions[layer].action != regulator::Action::Drop && !placement.empty();
  return is_shown ? &placement : nullptr;
}

}  // namespace

std::vector<DecisionRow> decision_rows(const PipelineState& state, const FrameReport& report) {
  std::vector<DecisionRow> rows;
  for (const int layer : layers_with_lines(state, report))
    rows.emplace_back(report, report.plan.decisions[layer], placement_shown(state, report, layer));
  for (const ShadowMapRow& map : report.shadow_maps) rows.emplace_back(report, map);
  return rows;
}

const ColumnTable<DecisionRow>& decision_table() {
  static const ColumnTable<DecisionRow> table = [] {
    ColumnTable<DecisionRow> t{"decisions", "talisman.decision/1", {}, {}};
    for (const DecisionColumns& part :
         {what_was_done(), warp_columns(), placement_columns(), what_is_shown(), level_columns(),
          late_columns(), geometric_columns(), photometric_columns(), remaining_fiducials(), chunk_columns(),
          cost_columns()})
      t.columns.insert(t.columns.end(), part.begin(), part.end());
    t.groups = {{"sprite", "of layers whose sprite is shown", true,
                 [](const DecisionRow& r) { return r.placement != nullptr; }},
                {"fiducials", "of layers in view that have an old sprite", true,
                 [](const DecisionRow& r) { return assessment(r).has_sprite && assessment(r).in_view; }},
                {"chunks", "with --refresh chunks, of layers some of whose chunks are drawn or were", false,
                 [](const DecisionRow& r) { return r.decision.chunks.has_value(); }}};
    return t;
  }();
  return table;
}

}  // namespace talisman::sequences
