// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/shadow_map_planning.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "fiducials/shade_drift.h"
#include "layers/shade_state.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Layer;
using layers::LayerState;
using layers::Light;
using layers::ShadeTrace;
using regulator::Action;
using regulator::MapAssessment;
using regulator::Policy;

constexpr int kFacesAround = 6;
constexpr int kTrustedPoints = 8;  // a map is fitted to nothing: its fiducial is not in doubt

// --- What a map costs

/// Casters by layer, as their characteristic points.
std::vector<std::vector<dvec3>> points_of_casters(const LayerTable& layers,
                                                  const std::vector<LayerState>& states) {
  std::vector<std::vector<dvec3>> points(layers.size());
  for (const Layer& layer : layers)
    for (const int caster : layer.casters) points[caster] = states[caster].world_points;
  return points;
}

/// Does one perspective picture take all points in, seen from `eye` towards their middle?
bool fit_into_one_face(const dvec3& eye, const std::vector<std::vector<dvec3>>& points) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const auto& of_layer : points)
    for (const dvec3& p : of_layer) lo = glm::min(lo, p), hi = glm::max(hi, p);
  const dvec3 towards = 0.5 * (lo + hi) - eye;
  const double distance = glm::length(towards);
  if (!(distance > 0) || !std::isfinite(distance)) return true;
  for (const auto& of_layer : points)
    for (const dvec3& p : of_layer) {
      const double along = glm::dot(p - eye, towards) / distance;
      const double across = glm::length(p - eye - along * towards / distance);
      if (!(along > 0) || across > chunker::kWidestShadowTan * along) return false;
    }
  return true;
}

int faces_of(const layers::LightState& light, const std::vector<std::vector<dvec3>>& points) {
  if (light.kind == Light::Kind::Directional) return 1;
  const bool is_narrow = light.kind == Light::Kind::Spot && light.outer_cone_rad < 1.5 &&
                         std::tan(light.outer_cone_rad) <= chunker::kWidestShadowTan;
  return is_narrow || fit_into_one_face(light.position, points) ? 1 : kFacesAround;
}

ShadowMapCost cost_of_map(std::int64_t polygons, int faces, int side_px) {
  const std::int64_t side = side_px, chunks = (side + chunker::kChunkSize - 1) / chunker::kChunkSize;
  return {polygons, faces * side * side, faces * chunks * chunks};
}

regulator::LayerCost as_layer_cost(const ShadowMapCost& cost) {
  return {cost.polygons, cost.pixels, cost.chunks, cost.pixels * static_cast<std::int64_t>(sizeof(float))};
}

// --- How far shadows have run

/// May a layer be drawn from an old map?
bool may_hold(const regulator::RegulatorOptions& options) {
  return options.policy == Policy::Budget ||
         (options.policy == Policy::Threshold && options.thresholds.shadow_map_px > 0);
}

bool is_shadow_of(const ShadeTrace& trace, int light) {
  return trace.kind == ShadeTrace::Kind::Shadow && trace.light == light;
}

/// Puts the shadows of one light as they are in `old` into `state`.
void take_shadows(const LayerState& old, int light, LayerState& state) {
  if (old.traces.size() != state.traces.size()) {
    state.traces = old.traces;
    return;
  }
  for (std::size_t i = 0; i < state.traces.size(); ++i)
    if (is_shadow_of(state.traces[i], light)) state.traces[i] = old.traces[i];
}

/// All layers as they are now, with the shadows of one light as its map at hand has them.
std::vector<LayerState> states_with_old_shadows(const Pipeline& pipeline, const PipelineState& state,
                                                const FrameReport& report, const std::vector<LayerState>& now,
                                                int light) {
  const ShadowMapMemory& memory = state.maps[light];
  layers::SceneFrame frame = scene_as_known(pipeline, state, report.frame);
  frame.lights[light] = memory.key.light;
  std::vector<LayerState> cast = now;
  for (std::size_t id = 0; id < std::min(cast.size(), memory.world_points.size()); ++id)
    if (!memory.world_points[id].empty()) cast[id].world_points = memory.world_points[id];
  layers::capture_influences(frame, report.layers.set(), cast, {state.captured.at(report.frame).lights, now});
  std::vector<LayerState> old = now;
  for (std::size_t id = 0; id < old.size(); ++id) take_shadows(cast[id], light, old[id]);
  return old;
}

/// A layer that shows shadows only in what it mirrors has no trace of them.
bool shows_traces(const Layer& layer) { return layer.holds.shadows; }

void measure_motion(const std::vector<LayerState>& old, const std::vector<LayerState>& now,
                    const LayerTable& layers, MapAssessment& map) {
  fiducials::Report& fiducials = map.map.fiducials;
  fiducials.shade.computed = true;
  for (regulator::MapUse& use : map.uses) {
    const fiducials::ShadeMotion moved = fiducials::shade_motion(old[use.layer], now[use.layer]);
    use.moved_px = moved.px;
    if (!(moved.px > fiducials.shade.px)) continue;
    fiducials.shade = moved;
    fiducials.geometric.where_px = moved.where_px;
  }
  for (regulator::MapUse& use : map.uses)
    if (!shows_traces(layers[use.layer])) use.moved_px = fiducials.shade.px;
  fiducials.geometric.px = map.map.held_geometric_px = fiducials.shade.px;
}

// --- Names

std::string name_of_map(const Pipeline& pipeline, int light) {
  const auto of = [&](int i) {
    const std::string& name = pipeline.scene.lights[i].name;
    return "shadow map of " + (name.empty() ? "light " + std::to_string(i) : name);
  };
  const auto is_taken = [&](const std::string& name) {
    for (int other = 0; other < light; ++other)
      if (of(other) == name) return true;
    return std::any_of(pipeline.authored.begin(), pipeline.authored.end(),
                       [&](const Layer& layer) { return layer.name == name; });
  };
  std::string name = of(light);
  for (int suffix = 2; is_taken(name); ++suffix) name = of(light) + "#" + std::to_string(suffix);
  return name;
}

MapAssessment start_assessment(const Pipeline& pipeline, const PipelineState& state, int frame, int light) {
  const ShadowMapMemory& memory = state.maps[light];
  MapAssessment map;
  map.name = name_of_map(pipeline, light);
  map.map.layer = light;
  map.map.has_sprite = memory.instant.depicts_frame >= 0;
  map.map.frames_since_render = map.map.has_sprite ? std::abs(frame - memory.frame_rendered) : 0;
  map.map.frames_short_of_area = memory.frames_short_of_area;
  map.map.resolution_then = memory.instant.resolution;
  map.map.matched_points = kTrustedPoints;
  map.map.fitted.status = warp::FitStatus::Converged;
  map.map.fiducials.shade.why_not = "drawn whenever it is out of date";
  return map;
}

void add_uses(const Pipeline& pipeline, const FrameReport& report, std::vector<MapAssessment>& maps) {
  for (const Layer& layer : report.layers) {
    if (!report.assessments[layer.id].in_view) continue;
    const std::vector<int> lights = shadow_lights(pipeline.scene, report.layers.set(), layer);
    for (MapAssessment& map : maps)
      if (std::find(lights.begin(), lights.end(), map.map.layer) != lights.end())
        map.uses.push_back({layer.id, 0});
  }
  for (MapAssessment& map : maps) map.map.in_view = !map.uses.empty();
}

}  // namespace

ShadowMapsNow assess_shadow_maps(const Pipeline& pipeline, PipelineState& state, const FrameReport& report) {
  ShadowMapsNow now;
  const std::vector<LayerState>& states = captured_states(pipeline, state, report.frame);
  const std::vector<ShadowMapKey>& keys = state.captured.at(report.frame).shadow_maps;
  if (keys.empty()) return now;
  state.maps.resize(keys.size());
  now.costs.resize(keys.size());
  now.with_old_shadows.resize(keys.size());
  const auto points = points_of_casters(report.layers, states);
  const std::int64_t polygons = casting_polygons(pipeline.scene, report.layers.set());
  for (const int light : lights_with_maps(pipeline.scene, -1)) {
    now.costs[light] = cost_of_map(polygons, faces_of(keys[light].light, points),
                                   map_resolution_px(pipeline.scene.lights[light], 1));
    now.maps.push_back(start_assessment(pipeline, state, report.frame, light));
    MapAssessment& map = now.maps.back();
    map.map.cost = as_layer_cost(now.costs[light]);
    map.map.identical = map.map.has_sprite && state.maps[light].key == keys[light];
  }
  add_uses(pipeline, report, now.maps);
  if (!may_hold(pipeline.settings.regulator)) return now;
  for (MapAssessment& map : now.maps) {
    const int light = map.map.layer;
    if (map.map.identical) map.map.fiducials.shade = {true, "", 0, {0, 0}, -1};
    if (map.map.identical || !map.map.has_sprite || !map.map.in_view) continue;
    now.with_old_shadows[light] = states_with_old_shadows(pipeline, state, report, states, light);
    measure_motion(now.with_old_shadows[light], states, report.layers, map);
  }
  return now;
}

void set_resolution(const Pipeline& pipeline, double resolution, MapAssessment& map) {
  map.map.resolution = resolution;
  const Light& light = pipeline.scene.lights[map.map.layer];
  const int full = map_resolution_px(light, 1), side = map_resolution_px(light, resolution);
  const std::int64_t faces = map.map.cost.pixels / (std::int64_t{full} * full);
  if (side != full)
    map.map.cost = as_layer_cost(cost_of_map(map.map.cost.polygons, static_cast<int>(faces), side));
}

std::vector<ShadowMapRow> shadow_map_rows(const Pipeline& pipeline, const ShadowMapsNow& maps,
                                          const std::vector<regulator::LayerDecision>& decisions) {
  const int casting_parts = static_cast<int>(pipeline.authored.set().casting_parts.size());
  std::vector<ShadowMapRow> rows;
  for (std::size_t k = 0; k < maps.maps.size(); ++k) {
    const MapAssessment& map = maps.maps[k];
    ShadowMapRow row{map.name, map.map.layer, map.map, decisions[k], casting_parts, 0, {0, 0}};
    const double resolution =
        row.decision.action == Action::Rerender ? map.map.resolution : map.map.resolution_then;
    row.size_px = layers::ivec2(map_resolution_px(pipeline.scene.lights[row.light], resolution));
    row.decision.cost = {};  // counted with the sprites that look it up
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

/// Draws the map of a row as of `instant`.
void draw_map(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps, int instant,
              ShadowMapRow& row, FrameReport& report) {
  const MapAssessment& map = *std::find_if(maps.maps.begin(), maps.maps.end(),
                                           [&](const MapAssessment& m) { return m.map.layer == row.light; });
  const bool ahead = looks_ahead(pipeline);
  ShadowMapMemory& memory = state.maps[row.light];
  memory.key = state.captured.at(instant).shadow_maps[row.light];
  memory.instant = {row.light, instant, predicts(pipeline) ? report.frame : instant,
                    ahead ? 1 : map.map.resolution};
  memory.frame_rendered = report.frame;
  memory.frames_short_of_area = 0;
  if (may_hold(pipeline.settings.regulator))
    memory.world_points = points_of_casters(report.layers, captured_states(pipeline, state, instant));
  if (ahead && row.decision.action != Action::Rerender) {
    row.decision = regulator::keep_map(map, "sprites of other instants look it up");
    row.decision.action = Action::Rerender;
  }
  row.decision.shown_geometric_px = 0;
  ++row.pictures;
  row.decision.cost.polygons += map.map.cost.polygons;
  row.decision.cost.pixels += map.map.cost.pixels;
  row.decision.cost.chunks += map.map.cost.chunks;
  row.decision.cost.bytes = map.map.cost.bytes;
  ++report.shade.shadow_maps_drawn;
  report.shade.shadow_polygons += map.map.cost.polygons;
  report.shade.shadow_pixels += map.map.cost.pixels;
}

}  // namespace

void look_up_shadow_maps(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps, int layer,
                         int instant, FrameReport& report) {
  const layers::LayerSet& set = report.layers.set();
  LayerMemory& memory = state.memory[layer];
  memory.maps.clear();
  memory.has_old_shadows = false;
  report.shade.reflections_drawn += static_cast<int>(mirrors_in(set, set.layers[layer]).size());
  for (ShadowMapRow& row : report.shadow_maps) {
    const std::vector<int> lights = shadow_lights(pipeline.scene, set, set.layers[layer]);
    if (std::find(lights.begin(), lights.end(), row.light) == lights.end()) continue;
    ShadowMapMemory& map = state.maps[row.light];
    const bool is_current =
        map.instant.depicts_frame >= 0 && map.key == state.captured.at(instant).shadow_maps[row.light];
    const bool must_draw =
        looks_ahead(pipeline) ? !is_current : row.decision.action == Action::Rerender && row.pictures == 0;
    if (must_draw)
      draw_map(pipeline, state, maps, instant, row, report);
    else
      ++report.shade.shadow_maps_reused;
    const bool is_old = !must_draw && !is_current;
    if (is_old || map.instant.resolution != 1) memory.maps.push_back(map.instant);
    if (!is_old) continue;
    memory.has_old_shadows = true;
    const std::vector<LayerState>& old = maps.with_old_shadows[row.light];
    if (!old.empty()) take_shadows(old[layer], row.light, *memory.then);
  }
}

void finish_shadow_maps(PipelineState& state, FrameReport& report) {
  for (ShadowMapRow& row : report.shadow_maps) {
    ShadowMapMemory& memory = state.maps[row.light];
    if (row.pictures == 0)
      memory.frames_short_of_area = row.decision.short_of_area ? memory.frames_short_of_area + 1 : 0;
    if (row.decision.action != Action::Drop) row.decision.depicts_frame = memory.instant.depicts_frame;
  }
}

}  // namespace talisman::sequences
