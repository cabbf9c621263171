// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/lod/levels_now.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "layers/lod/levels.h"
#include "layers/lod/member_levels.h"
#include "regulator/lod/decide_lod.h"
#include "regulator/lod/selectors.h"
#include "regulator/profile.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {
namespace {

using layers::Layer;
using layers::LayerState;
using regulator::LayerAssessment;
using regulator::LevelChoice;
using regulator::LodSelector;

/// The lower resolution at which a sprite may be drawn, beside 1.
constexpr double kLowerResolution = 0.5;

/// Of the farthest corner of the display.
double most_tangent(const LayerState& now) {
  const double up = std::tan(now.camera.fov_y_rad / 2);
  const double aspect =
      now.view.display_px.y > 0 ? static_cast<double>(now.view.display_px.x) / now.view.display_px.y : 1;
  return up * std::sqrt(1 + aspect * aspect);
}

double focal_px(const LayerState& now) {
  return now.view.display_px.y / (2 * std::tan(now.camera.fov_y_rad / 2));
}

double error_px(const layers::LayerLevel& level, const LayerState& now) {
  return layers::level_error_px(level.error_m, now.nearest_w_m, focal_px(now), most_tangent(now));
}

/// Are its levels rungs of allowed errors, chosen part by part?
bool has_rungs(const Pipeline& pipeline, const Layer& layer) {
  return pipeline.settings.regulator.lod.by == LodSelector::Optimise &&
         layers::has_member_levels(pipeline.scene, layer);
}

layers::MemberLevels members_of(const Pipeline& pipeline, const Layer& layer,
                                const layers::ShownMembers& shown, int level) {
  return has_rungs(pipeline, layer) ? shown.at_rung(level) : shown.at_level(level);
}

/// As its sprite was drawn.
layers::MemberLevels members_of(const Pipeline& pipeline, const Layer& layer, const LayerMemory& memory) {
  return members_of(pipeline, layer, {pipeline.scene, layer, *memory.then, memory.placement}, memory.level);
}

/// Where levels are chosen part by part; else empty.
std::optional<layers::ShownMembers> shown_members(const Pipeline& pipeline, PipelineState& state, int frame,
                                                  const Layer& layer,
                                                  const layers::SpritePlacement& placement) {
  if (!layers::has_member_levels(pipeline.scene, layer)) return std::nullopt;
  return layers::ShownMembers(pipeline.scene, layer, captured_states(pipeline, state, frame)[layer.id],
                              placement);
}

/// A sprite that is drawn coarser, where that makes it cheaper.
void add_lower_resolution(const Pipeline& pipeline, PipelineState& state, int frame,
                          const regulator::RegulatorOptions& options, LayerAssessment& layer) {
  if (options.budget.min_resolution > kLowerResolution) return;
  const layers::SpritePlacement placement =
      placement_at_resolution(pipeline, state, layer.layer, frame, kLowerResolution);
  regulator::LayerCost lower = cost_of(pipeline, state.layers, layer.layer, placement);
  const Layer& drawn = state.layers[layer.layer];
  const auto shown = shown_members(pipeline, state, frame, drawn, placement);
  const std::size_t count = layer.levels.size();
  for (std::size_t k = 0; k < count; ++k) {
    LevelChoice way = layer.levels[k];
    lower.polygons = way.cost.polygons;
    if (shown) lower.polygons = members_of(pipeline, drawn, *shown, way.level).polygons;
    if (!(regulator::drawing_ms(lower, options) < regulator::drawing_ms(way.cost, options))) continue;
    way.cost = lower;
    way.resolution = kLowerResolution;
    layer.levels.push_back(way);
  }
}

/// The level that would be drawn, for a selector that looks at one layer at a time.
void choose_by_size(const regulator::RegulatorOptions& options, double px_per_polygon,
                    LayerAssessment& layer) {
  std::vector<std::int64_t> triangles;
  for (const LevelChoice& way : layer.levels) triangles.push_back(way.cost.polygons);
  const double s = options.lod.by == LodSelector::Feedback ? px_per_polygon : options.lod.px_per_polygon;
  const LevelChoice& way = layer.levels[static_cast<std::size_t>(
      regulator::level_by_size(static_cast<double>(layer.cost.pixels), triangles, s))];
  layer.level = way.level;
  layer.cost.polygons = way.cost.polygons;
  if (!layer.has_sprite) return;
  const double mended_px = layer.level_then_px - way.error_px;
  if (!(mended_px > 0)) return;
  layer.fiducials.geometric.px += mended_px;
  layer.identical = false;
}

/// The ways to draw the layer at full resolution, by level.
void add_levels(const Pipeline& pipeline, PipelineState& state, int frame, LayerAssessment& assessment) {
  const Layer& layer = state.layers[assessment.layer];
  const LayerState& now = captured_states(pipeline, state, frame)[layer.id];
  const auto shown =
      shown_members(pipeline, state, frame, layer, captured_placement(pipeline, state, layer.id, frame));
  const int count = has_rungs(pipeline, layer) ? layers::kRungs : layers::level_count(pipeline.scene, layer);
  for (int k = 0; k < count; ++k) {
    LevelChoice way{k, 1, assessment.cost, 0};
    if (shown) {
      const layers::MemberLevels members = members_of(pipeline, layer, *shown, k);
      way.cost.polygons = members.polygons;
      way.error_px = members.error_px;
    } else {
      const layers::LayerLevel level = layers::level_of(pipeline.scene, layer, k, now.world_from_part);
      way.cost.polygons = level.polygons;
      way.error_px = k == 0 ? 0 : error_px(level, now);
    }
    assessment.levels.push_back(way);
  }
}

void assess_levels_of(const Pipeline& pipeline, PipelineState& state, int frame,
                      const regulator::RegulatorOptions& options, double px_per_polygon,
                      LayerAssessment& assessment) {
  const Layer& layer = state.layers[assessment.layer];
  const bool optimises = options.lod.by == LodSelector::Optimise;
  if (!optimises && layers::level_count(pipeline.scene, layer) < 2) return;
  add_levels(pipeline, state, frame, assessment);
  const int count = static_cast<int>(assessment.levels.size());
  assessment.level_then = std::min(state.memory[layer.id].level, count - 1);
  assessment.level_then_px = assessment.levels[static_cast<std::size_t>(assessment.level_then)].error_px;
  if (optimises)
    add_lower_resolution(pipeline, state, frame, options, assessment);
  else
    choose_by_size(options, px_per_polygon, assessment);
}

}  // namespace

void assess_levels(const Pipeline& pipeline, PipelineState& state, int frame,
                   const regulator::RegulatorOptions& options, std::vector<LayerAssessment>& assessments) {
  if (!regulator::chooses_levels(options)) return;
  const double px_per_polygon = state.px_per_polygon.value_or(options.lod.px_per_polygon);
  for (LayerAssessment& assessment : assessments) {
    if (!assessment.in_view) continue;
    const Layer& layer = state.layers[assessment.layer];
    assessment.may_be_skipped = layer.kind == layers::LayerKind::Geometry &&
                                layer.factored == layers::HeldTerms{} && !layer.holds.reflection;
    assess_levels_of(pipeline, state, frame, options, px_per_polygon, assessment);
  }
}

regulator::LodSolver* solver_of(PipelineState& state, const regulator::RegulatorOptions& options) {
  const bool solves = regulator::chooses_levels(options) && options.lod.by == LodSelector::Optimise;
  if (!solves) return nullptr;
  if (!state.solver) state.solver.make();
  return &*state.solver;
}

void place_at_level(const Pipeline& pipeline, PipelineState& state, int frame,
                    const regulator::LayerDecision& decision) {
  if (solver_of(state, pipeline.settings.regulator) == nullptr || decision.resolution == 1) return;
  const layers::SpritePlacement placement =
      placement_at_resolution(pipeline, state, decision.layer, frame, decision.resolution);
  state.captured.at(frame).placements[static_cast<std::size_t>(decision.layer)] = placement;
}

namespace {

bool is_drawn_by_member(const Pipeline& pipeline, const Layer& layer, const LayerMemory& memory) {
  return regulator::chooses_levels(pipeline.settings.regulator) && memory.then &&
         layers::has_member_levels(pipeline.scene, layer) &&
         (has_rungs(pipeline, layer) || layers::level_count(pipeline.scene, layer) > 1);
}

}  // namespace

Layer drawn_layer(const Pipeline& pipeline, const Layer& layer, const LayerMemory& memory) {
  if (is_drawn_by_member(pipeline, layer, memory)) {
    Layer drawn = layer;
    drawn.parts = members_of(pipeline, layer, memory).parts;
    return drawn;
  }
  if (memory.level == 0 || !layers::may_have_levels(layer)) return layer;
  return layers::layer_at_level(pipeline.scene, layer, memory.level);
}

void lower_cost(const Pipeline& pipeline, const Layer& layer, const LayerMemory& memory,
                regulator::LayerCost& cost) {
  if (is_drawn_by_member(pipeline, layer, memory))
    cost.polygons = members_of(pipeline, layer, memory).polygons;
  else if (memory.level > 0)
    cost.polygons = layers::level_of(pipeline.scene, layer, memory.level, {}).polygons;
}

double planned_drawing_ms(const FrameReport& report) {
  std::int64_t polygons = report.shade.shadow_polygons, pixels = 0;
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    polygons += d.cost.polygons;
    pixels += d.cost.pixels;
  }
  const auto of_sprites = static_cast<double>(pixels - report.blended_pixels);
  const std::int64_t filled =
      std::llround(of_sprites * report.depth_complexity) + report.shade.shadow_pixels + report.blended_pixels;
  return regulator::modelled_time(regulator::talisman_1996(), polygons, filled, 0).render_ms;
}

void note_drawing_time(const Pipeline& pipeline, PipelineState& state, const FrameReport& report) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  if (!regulator::chooses_levels(options) || options.lod.by != LodSelector::Feedback) return;
  state.px_per_polygon = regulator::next_px_per_polygon(
      state.px_per_polygon.value_or(options.lod.px_per_polygon), planned_drawing_ms(report),
      options.budget.ms, options.lod.feedback_gain);
}

}  // namespace talisman::sequences
