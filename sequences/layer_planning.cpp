// SPDX-License-Identifier: Apache-2.0
#include "sequences/layer_planning.h"

#include <algorithm>

#include "fiducials/fiducials.h"
#include "sequences/motion_blur.h"
#include "sequences/light_planning.h"
#include "layers/shade_state.h"
#include "warp/shade.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SpritePlacement;
using regulator::LayerAssessment;

/// Extents grow by velocity × `expected_reuse`; `soon` is the state one frame later.
SpritePlacement place_layer(const Pipeline& pipeline, const LayerState& now, const LayerState& soon,
                            double expected_reuse) {
  const Layer& layer = pipeline.layers.layers[now.layer];
  layers::ExtentOptions extents = pipeline.settings.extents;
  extents.expected_reuse_frames = expected_reuse * layer.preferences.share_of_expected_motion;
  layers::PlacementOptions placement = pipeline.settings.placement;
  placement.resolution_scale *= layer.preferences.resolution_scale;
  if (layer.preferences.motion_blur > 0) apply_motion_blur(pipeline, now, placement);
  return layers::place_sprite(now, soon, pipeline.bounds[layer.id].hull, extents, placement);
}

/// The cost before the placement is known: the part of the layer's bounds that is on the display.
regulator::LayerCost estimated_cost(const Layer& layer, const LayerState& now) {
  const layers::RectD display{{0, 0}, layers::dvec2(now.view.display_px)};
  const layers::RectD seen = layers::intersection(now.screen_bounds_px, display);
  const double scale = layer.preferences.resolution_scale;
  return cost_of(layer,
                 {static_cast<int>(seen.width() * scale + 1), static_cast<int>(seen.height() * scale + 1)});
}

/// For how many frames a new sprite of the layer will probably be moved by a warp: at most what the policy
/// expects, and no more than twice as long as the old one lasted, so that a layer that is drawn every frame
/// is not drawn larger than it needs to be. Who looks ahead judges a sprite before it is known when the old
/// one fails, and so for no one layer's past.
double expected_reuse_frames(const Pipeline& pipeline, const LayerMemory& memory, int frame) {
  const double by_policy = regulator::expected_reuse_frames(pipeline.settings.regulator,
                                                            pipeline.settings.extents.expected_reuse_frames);
  if (looks_ahead(pipeline) || !memory.then) return by_policy;
  return std::min(by_policy, 2.0 * (frame - memory.frame_rendered));
}

}  // namespace

bool looks_ahead(const Pipeline& pipeline) {
  const regulator::Policy policy = pipeline.settings.regulator.policy;
  return policy == regulator::Policy::Lookahead || policy == regulator::Policy::Oracle;
}

double time_of(const Pipeline& pipeline, int frame) { return frame / pipeline.settings.fps; }

const std::vector<LayerState>& states_at(const Pipeline& authored, PipelineState& state, int frame) {
  CapturedFrame& captured = state.captured[frame];
  if (captured.generation == state.order.generation) return captured.states;
  const Pipeline& pipeline = with_aggregates(authored, state);
  captured.generation = state.order.generation;
  captured.states.resize(pipeline.layers.layers.size());
  captured.placements.resize(captured.states.size());
  std::optional<layers::SceneFrame> scene_frame;  // evaluated only if something is missing
  for (const Layer& layer : pipeline.layers.layers) {
    LayerState& layer_state = captured.states[layer.id];
    if (layer_state.layer == layer.id || !exists_now(pipeline, state, layer.id)) continue;
    if (!scene_frame) scene_frame = pipeline.scene.at(time_of(pipeline, frame));
    layer_state =
        layer.base >= 0
            ? layers::shade_state(captured.states[layer.base], layer)
            : layers::capture(*scene_frame, layer, pipeline.bounds[layer.id], pipeline.settings.view);
  }
  if (!scene_frame) return captured.states;
  layers::capture_influences(*scene_frame, pipeline.layers, captured.states);
  captured.shadow_maps = shadow_map_keys(pipeline, *scene_frame);
  return captured.states;
}

void forget_states_before(PipelineState& state, int frame) {
  state.captured.erase(state.captured.begin(), state.captured.lower_bound(frame));
}

const SpritePlacement& placement_at(const Pipeline& pipeline, PipelineState& state, int layer, int frame) {
  const LayerState& now = states_at(pipeline, state, frame)[layer];
  std::optional<SpritePlacement>& known = state.captured.at(frame).placements[layer];
  if (known) return *known;
  const double expected_reuse = expected_reuse_frames(pipeline, state.memory[layer], frame);
  known = expected_reuse > 0
              ? place_layer(pipeline, now, states_at(pipeline, state, frame + 1)[layer], expected_reuse)
              : placement_without_growth(pipeline, now);
  return *known;
}

SpritePlacement placement_without_growth(const Pipeline& pipeline, const LayerState& now) {
  return place_layer(pipeline, now, now, 0);
}

regulator::LayerCost cost_of(const Layer& layer, layers::ivec2 size_px) {
  constexpr int kChunk = chunker::kChunkSize;
  const std::int64_t w = std::max(size_px.x, 0), h = std::max(size_px.y, 0);
  regulator::LayerCost cost;
  cost.polygons = layer.polygons;
  cost.pixels = w * h;
  cost.chunks = ((w + kChunk - 1) / kChunk) * ((h + kChunk - 1) / kChunk);
  cost.bytes = cost.chunks * static_cast<std::int64_t>(sizeof(chunker::Chunk));
  return cost;
}

LayerAssessment assess_sprite(const Pipeline& pipeline, const LayerState& then,
                              const SpritePlacement& placement, const LayerState& now,
                              int frames_since_render) {
  LayerAssessment assessment;
  assessment.layer = now.layer;
  assessment.preferences = pipeline.layers.layers[now.layer].preferences;
  assessment.in_view = assessment.has_sprite = true;
  assessment.frames_since_render = frames_since_render;
  assessment.identical = now.same_pixels(then);
  const layers::Correspondences matched = layers::correspond(then, now, pipeline.bounds[now.layer].hull);
  // An empty sprite holds nothing of what is in view now, wherever its points went.
  const bool shows_something = matched.overlap && !placement.empty();
  assessment.matched_points = shows_something ? static_cast<int>(matched.then_px.size()) : 0;
  if (assessment.identical)
    assessment.fitted.status = warp::FitStatus::Converged;  // the identity, without error
  else
    assessment.fitted = warp::fit(then, now, matched, pipeline.settings.curve, pipeline.settings.fit);
  assessment.fiducials = fiducials::assess(then, now, placement, matched, assessment.fitted);
  if (assessment.preferences.motion_blur > 0) judge_motion_blur(pipeline, then, now, assessment);
  assess_light_and_faces(pipeline, then, now, assessment.fiducials);
  for (std::size_t i = 0; i < matched.then_px.size(); ++i)
    assessment.held_geometric_px =
        std::max(assessment.held_geometric_px, glm::distance(matched.then_px[i], matched.now_px[i]));
  assessment.held_geometric_px += assessment.fiducials.shade.px;
  return assessment;
}

LayerAssessment assess_layer(const Pipeline& pipeline, PipelineState& state, int layer_id, int frame) {
  const Layer& layer = pipeline.layers.layers[layer_id];
  const LayerMemory& memory = state.memory[layer_id];
  const LayerState& now = states_at(pipeline, state, frame)[layer_id];
  LayerAssessment assessment;
  if (now.touches_display && memory.then)
    assessment = assess_sprite(pipeline, *memory.then, memory.placement, now, frame - memory.frame_rendered);
  assessment.layer = layer.id;
  assessment.preferences = layer.preferences;
  assessment.in_view = now.touches_display;
  assessment.has_sprite = memory.then.has_value();
  if (!assessment.in_view) return assessment;
  const bool must_be_exact = pipeline.settings.regulator.policy == regulator::Policy::Budget;
  assessment.cost = must_be_exact ? cost_of(layer, placement_at(pipeline, state, layer_id, frame).size_px)
                                  : estimated_cost(layer, now);
  return assessment;
}

}  // namespace talisman::sequences
