// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/layer_planning.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "fiducials/fiducials.h"
#include "layers/built_effects.h"
#include "layers/moving_picture.h"
#include "layers/shade_state.h"
#include "regulator/policies.h"
#include "regulator/resolution.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/light_planning.h"
#include "sequences/pipeline/motion_blur.h"
#include "sequences/pipeline/refresh/refresh.h"
#include "sequences/pipeline/shadow_map_planning.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;
using layers::SpritePlacement;
using regulator::LayerAssessment;
using regulator::Policy;

bool is_blurred(const layers::LayerPreferences& preferences) {
  return layers::is_built(layers::Effect::MotionBlur) && preferences.motion_blur > 0;
}

/// Texels per display pixel that the layer's author asks for.
double own_resolution(const Layer& layer) {
  return layers::is_built(layers::Effect::LayerResolution) ? layer.preferences.resolution_scale : 1;
}

/// Extents grow by velocity × `expected_reuse`; `soon` is the state one frame later. `resolution` is
/// relative to what the layer's author asks for.
SpritePlacement place_layer(const Pipeline& pipeline, const LayerTable& layers, const LayerState& now,
                            const LayerState& soon, double expected_reuse, double resolution = 1) {
  const Layer& layer = layers[now.layer];
  layers::ExtentOptions extents = pipeline.settings.extents;
  extents.expected_reuse_frames = expected_reuse * layer.preferences.share_of_expected_motion;
  extents.whole = layer.preferences.whole_extents && expected_reuse > 0;
  layers::PlacementOptions placement = pipeline.settings.placement;
  placement.resolution_scale *= own_resolution(layer) * resolution;
  if (is_blurred(layer.preferences)) apply_motion_blur(layers, now, placement);
  return layers::place_sprite(now, soon, layers.bound(layer.id).hull, extents, placement);
}

/// The cost before the placement is known: the part of the layer's bounds that is on the display.
regulator::LayerCost estimated_cost(const Pipeline& pipeline, const LayerTable& layers,
                                    const LayerState& now) {
  const Layer& layer = layers[now.layer];
  const layers::RectD display{{0, 0}, layers::dvec2(now.view.display_px)};
  const layers::RectD seen = layers::intersection(now.screen_bounds_px, display);
  const double scale = own_resolution(layer);
  SpritePlacement placement;
  placement.size_px = {static_cast<int>(seen.width() * scale + 1),
                       static_cast<int>(seen.height() * scale + 1)};
  return cost_of(pipeline, layers, layer.id, placement);
}

/// For how many frames a new sprite of the layer will probably be moved by a warp: at most what the policy
/// expects, and no more than twice as long as the old one lasted, so that a layer that is drawn every frame
/// is not drawn larger than it needs to be. Who looks ahead judges a sprite before it is known when the old
/// one fails, and so for no one layer's past.
double expected_reuse_frames(const Pipeline& pipeline, const LayerMemory& memory, int frame) {
  const double by_policy = regulator::expected_reuse_frames(pipeline.settings.regulator,
                                                            pipeline.settings.extents.expected_reuse_frames);
  if (looks_ahead(pipeline) || !memory.then) return by_policy;
  return std::min(by_policy, 2.0 * std::abs(frame - memory.frame_rendered));
}

/// Sampling is judged by the texels that the layer's author asks for, not by the coarser ones of a sprite
/// whose resolution was lowered.
void see_through_resolution(LayerAssessment& assessment, double resolution) {
  assessment.resolution_then = resolution;
  if (resolution == 1) return;
  assessment.fiducials.sampling.magnification /= resolution;
  assessment.fiducials.sampling.minification /= resolution;
}

}  // namespace

bool looks_ahead(const Pipeline& pipeline) {
  const Policy policy = pipeline.settings.regulator.policy;
  return policy == Policy::Lookahead || policy == Policy::Oracle;
}

bool draws_sprites(const Pipeline& pipeline) {
  const Policy policy = pipeline.settings.regulator.policy;
  return policy != Policy::Direct && policy != Policy::Predictive;
}

warp::Curve curve_of(const Pipeline& pipeline, const Layer& layer) {
  if (layer.preferences.warp.empty() || !pipeline.settings.layers_own_warps) return pipeline.settings.curve;
  return warp::curve_from_name(layer.preferences.warp).value_or(pipeline.settings.curve);
}

namespace {

using CapturedIterator = std::map<int, CapturedFrame>::iterator;

void forget(PipelineState& state, CapturedIterator first, CapturedIterator last) {
  for (auto it = first; it != last; ++it) state.forgotten.push_back(std::move(it->second));
  state.captured.erase(first, last);
}

/// The frame as it was captured before, or an empty one in the memory of one that was forgotten; not of the last of
/// them, of which known_beside may still tell.
CapturedFrame& captured_frame(PipelineState& state, int frame) {
  const auto [it, is_new] = state.captured.try_emplace(frame);
  if (!is_new || state.forgotten.size() < 2) return it->second;
  it->second = std::move(state.forgotten.front());
  state.forgotten.erase(state.forgotten.begin());
  it->second.generation = -1;
  for (LayerState& layer : it->second.states) layer.layer = -1;
  it->second.placements.assign(it->second.placements.size(), std::nullopt);
  return it->second;
}

/// What is known of the frame before that one, or else of the one after it, or of the one that was forgotten last.
layers::KnownInfluences known_beside(const PipelineState& state, int frame) {
  const auto at = state.captured.find(frame), after = std::next(at);
  if (at != state.captured.begin()) return {std::prev(at)->second.lights, std::prev(at)->second.states};
  if (after != state.captured.end()) return {after->second.lights, after->second.states};
  if (state.forgotten.empty()) return {};
  return {state.forgotten.back().lights, state.forgotten.back().states};
}

/// Does the picture of that beat stand in `frame`?
bool continues(const Pipeline& pipeline, const BeatMemory& beat, int frame) {
  const int period = pipeline.settings.regulator.hold_frames;
  return frame % period != 0 && frame / period == beat.frame / period;
}

}  // namespace

void begin_frame(const Pipeline& pipeline, PipelineState& state, int frame) {
  if (!state.authored.is_copy_of(pipeline.authored)) state.beat.reset();
  adopt_layers(pipeline, state);
  const Policy policy = pipeline.settings.regulator.policy;
  auto& captured = state.captured;
  if (state.planned_with != pipeline.settings.regulator || predicts(pipeline))
    forget(state, captured.begin(), captured.end());
  if (state.planned_with != pipeline.settings.regulator) state.beat.reset();
  state.planned_with = pipeline.settings.regulator;
  if (state.beat && !continues(pipeline, *state.beat, frame)) state.beat.reset();
  state.now = frame;
  forget_seen(state);
  state.motion.reset();
  if (predicts(pipeline)) state.motion = motion_known(pipeline, frame);
  if (policy == Policy::Oracle) return;  // any frame of the sequence may be asked for again
  forget(state, captured.begin(), captured.lower_bound(frame));
  if (policy != Policy::Lookahead) forget(state, captured.upper_bound(frame + 1), captured.end());
}

void capture_layer(const LayerTable& table, const Layer& layer, const layers::FrameCapture& capture,
                   std::vector<LayerState>& states) {
  if (layer.base >= 0 && layer.kind != layers::LayerKind::Light)  // which is lit by a light of its own
    states[layer.id] = layers::shade_state(states[layer.base], layer);
  else
    capture.capture(layer, table.bound(layer.id), states[layer.id]);
}

const std::vector<LayerState>& captured_states(const Pipeline& pipeline, PipelineState& state, int frame) {
  CapturedFrame& captured = captured_frame(state, frame);
  if (captured.generation == state.order.generation) return captured.states;
  captured.generation = state.order.generation;
  captured.states.resize(state.layers.size());
  captured.placements.resize(captured.states.size());
  const SeenParts* const seen = seen_at(pipeline, state, frame);
  captured.culled.assign(seen ? captured.states.size() : 0, 0);
  std::optional<layers::SceneFrame> expected;
  const SceneFrame* scene_frame = nullptr;  // evaluated only if something is missing
  std::optional<layers::FrameCapture> capture;
  for (const Layer& layer : state.layers) {
    LayerState& layer_state = captured.states[layer.id];
    const bool is_culled = seen && !layer.is_aggregate() && !seen->layer[layer.id];
    if (is_culled) captured.culled[layer.id] = 1;
    if (layer_state.layer == layer.id || !exists_now(state, layer.id)) continue;
    if (!scene_frame) {
      if (state.motion && frame > state.motion->frame) expected = scene_as_known(pipeline, state, frame);
      scene_frame = expected ? &*expected : &scene_now(pipeline, state, frame);
      capture.emplace(*scene_frame, pipeline.settings.view);
    }
    if (is_culled && !pipeline.culling->is_looked_at(layer.id)) {
      capture->leave_out(layer, layer_state);
      continue;
    }
    capture_layer(state.layers, layer, *capture, captured.states);
    if (is_culled) hide(layer_state);
  }
  if (!scene_frame) return captured.states;
  if (any_shutter_open(state.layers))
    capture_motion(pipeline, state.layers, scene_as_known(pipeline, state, other_frame(pipeline, frame)),
                   frame, captured.states);
  layers::capture_influences(*scene_frame, state.layers.set(), captured.states, known_beside(state, frame));
  if (any_shadows(state.layers.set())) captured.lights = scene_frame->lights;
  captured.shadow_maps = shadow_map_keys(pipeline.scene, state.layers.set(), *scene_frame);
  return captured.states;
}

const LayerState& captured_motion(const Pipeline& pipeline, PipelineState& state, int layer, int frame) {
  captured_states(pipeline, state, frame);
  CapturedFrame& captured = state.captured.at(frame);
  LayerState& layer_state = captured.states[layer];
  if (captured.culled.empty() || !captured.culled[layer] || pipeline.culling->is_looked_at(layer))
    return layer_state;
  layers::FrameCapture(scene_now(pipeline, state, frame), pipeline.settings.view)
      .capture(state.layers[layer], state.layers.bound(layer), layer_state);
  hide(layer_state);
  return layer_state;
}

SpritePlacement placement_at_resolution(const Pipeline& pipeline, PipelineState& state, int layer, int frame,
                                        double resolution) {
  const LayerState& now = captured_states(pipeline, state, frame)[layer];
  const double expected_reuse = expected_reuse_frames(pipeline, state.memory[layer], frame);
  if (!(expected_reuse > 0)) return place_layer(pipeline, state.layers, now, now, 0, resolution);
  return place_layer(pipeline, state.layers, now, captured_motion(pipeline, state, layer, frame + 1),
                     expected_reuse, resolution);
}

const SpritePlacement& captured_placement(const Pipeline& pipeline, PipelineState& state, int layer,
                                          int frame) {
  captured_states(pipeline, state, frame);
  std::optional<SpritePlacement>& known = state.captured.at(frame).placements[layer];
  if (!known) known = placement_at_resolution(pipeline, state, layer, frame, 1);
  return *known;
}

void fit_resolutions(const Pipeline& pipeline, PipelineState& state, int frame,
                     const regulator::RegulatorOptions& options, std::vector<LayerAssessment>& assessments,
                     std::vector<regulator::MapAssessment>& maps) {
  std::vector<LayerAssessment> all = assessments;
  for (const regulator::MapAssessment& map : maps) all.push_back(map.map);
  regulator::regulate_resolutions(all, options);
  for (std::size_t i = 0; i < assessments.size(); ++i) {
    LayerAssessment& layer = assessments[i];
    layer.resolution = all[i].resolution;
    if (!layer.in_view || layer.resolution == 1) continue;
    std::optional<SpritePlacement>& placement = state.captured.at(frame).placements[layer.layer];
    placement = placement_at_resolution(pipeline, state, layer.layer, frame, layer.resolution);
    layer.cost = cost_of(pipeline, state.layers, layer.layer, *placement);
  }
  for (std::size_t k = 0; k < maps.size(); ++k)
    set_resolution(pipeline, all[assessments.size() + k].resolution, maps[k]);
}

SpritePlacement placement_without_growth(const Pipeline& pipeline, const LayerTable& layers,
                                         const LayerState& now) {
  return place_layer(pipeline, layers, now, now, 0);
}

SpritePlacement mirrored_placement(const SpritePlacement& sprite, int max_sprite_px) {
  const layers::Affine2& m = sprite.screen_from_sprite;
  layers::RectD bounds;
  for (const layers::dvec2& corner :
       {layers::dvec2{0, 0}, layers::dvec2{1, 0}, layers::dvec2{0, 1}, layers::dvec2{1, 1}})
    bounds.include(m(corner * layers::dvec2(sprite.size_px)));
  const double texel_px = std::sqrt(std::fabs(m.determinant()));
  const double step = std::max({texel_px, bounds.width() / max_sprite_px, bounds.height() / max_sprite_px});
  // One texel more on each side, and texels on pixels where their densities are equal.
  const layers::dvec2 lo = step * (glm::floor(bounds.lo / step) - 1.0);
  const layers::dvec2 count = glm::ceil((bounds.hi - lo) / step) + 1.0;
  SpritePlacement placement;
  placement.screen_from_sprite = {step, 0, lo.x, 0, step, lo.y};
  placement.size_px = layers::ivec2(count);
  return placement;
}

namespace {

void add_area(layers::ivec2 size_px, std::int64_t times, regulator::LayerCost& cost) {
  constexpr int kChunk = chunker::kChunkSize;
  const std::int64_t w = std::max(size_px.x, 0), h = std::max(size_px.y, 0);
  cost.pixels += times * w * h;
  cost.chunks += times * ((w + kChunk - 1) / kChunk) * ((h + kChunk - 1) / kChunk);
}

}  // namespace

regulator::LayerCost cost_of(const Pipeline& pipeline, const LayerTable& layers, int layer,
                             const SpritePlacement& placement) {
  regulator::LayerCost cost;
  cost.polygons = layers[layer].polygons;
  add_area(placement.size_px, 1, cost);
  cost.bytes = cost.chunks * static_cast<std::int64_t>(sizeof(chunker::Chunk));
  const std::size_t mirrors = placement.empty() ? 0 : mirrors_in(layers.set(), layers[layer]).size();
  if (mirrors > 0)
    add_area(mirrored_placement(placement, pipeline.settings.placement.max_sprite_px).size_px,
             static_cast<std::int64_t>(mirrors), cost);
  return cost;
}

namespace {

/// The worst place is the nearest one on the display, where it lies beyond its edge; and if the layer is too far
/// off because something ran over it, that is named.
void finish_geometric(const Pipeline& pipeline, const LayerTable& layers, const LayerState& now,
                      fiducials::Report& report) {
  report.geometric.where_px =
      glm::clamp(report.geometric.where_px, layers::dvec2(0), layers::dvec2(now.view.display_px));
  const double most_px = pipeline.settings.regulator.thresholds.geometric_px /
                         layers[now.layer].preferences.importance.geometric;
  if (report.shade.px > 0 && report.geometric.px > most_px)
    report.shade.what = shade_in_words(pipeline, layers, now, report.shade);
}

}  // namespace

LayerAssessment assess_sprite(const Pipeline& pipeline, const LayerTable& layers, const LayerState& then,
                              const SpritePlacement& placement, const LayerState& now,
                              int frames_since_render) {
  LayerAssessment assessment;
  assessment.layer = now.layer;
  assessment.preferences = layers[now.layer].preferences;
  assessment.in_view = assessment.has_sprite = true;
  assessment.frames_since_render = frames_since_render;
  assessment.identical = now.same_pixels(then);
  if (layers::is_built(layers::Effect::MovingPicture) && then.pictures != now.pictures)
    assessment.new_picture = layers::new_picture_in_words(pipeline.scene, then.pictures, now.pictures);
  const layers::Correspondences matched =
      layers::correspond(then, now, layers.bound(now.layer).hull, frames_since_render);
  // An empty sprite holds nothing of what is in view now, wherever its points went.
  const bool shows_something = matched.overlap && !placement.empty();
  assessment.matched_points = shows_something ? static_cast<int>(matched.then_px.size()) : 0;
  if (assessment.identical)
    assessment.fitted.status = warp::FitStatus::Converged;  // the identity, without error
  else
    assessment.fitted =
        warp::fit(then, now, matched, curve_of(pipeline, layers[now.layer]), pipeline.settings.fit);
  assessment.fiducials = fiducials::assess(then, now, placement, matched, assessment.fitted);
  if (assessment.preferences.whole_extents)
    assessment.fiducials.sampling.magnification /= placement.density_kept;
  if (is_blurred(assessment.preferences)) judge_motion_blur(layers, then, now, assessment);
  assess_light_and_faces(pipeline, layers, then, now, assessment.fiducials);
  for (std::size_t i = 0; i < matched.then_px.size(); ++i)
    assessment.held_geometric_px =
        std::max(assessment.held_geometric_px, glm::distance(matched.then_px[i], matched.now_px[i]));
  assessment.held_geometric_px += assessment.fiducials.shade.px;
  if (matched.then_px.empty() && !assessment.identical) assessment.held_geometric_px = warp::kHugePx;
  return assessment;
}

void note_rest(const Pipeline& pipeline, PipelineState& state, int frame) {
  if (pipeline.settings.regulator.settle_frames < 1) return;
  const std::vector<LayerState>& states = captured_states(pipeline, state, frame);
  for (const Layer& layer : state.layers) {
    const LayerState& now = states[layer.id];
    RestMemory& rest = state.memory[layer.id].rest;
    if (now.layer != layer.id || rest.frame == frame) continue;
    const bool rests = rest.seen && rest.frame == frame - 1 && now.same_pixels(*rest.seen);
    rest.frames = rests ? rest.frames + 1 : 0;
    if (!rests) rest.seen = now;
    rest.frame = frame;
  }
}

LayerAssessment assess_layer(const Pipeline& pipeline, PipelineState& state, int layer_id, int frame) {
  const Layer& layer = state.layers[layer_id];
  const LayerMemory& memory = state.memory[layer_id];
  const LayerState& now = captured_states(pipeline, state, frame)[layer_id];
  LayerAssessment assessment;
  const bool is_held = pipeline.settings.regulator.policy == Policy::Hold;  // shown, in view or not
  if ((now.touches_display || is_held) && memory.then)
    assessment = assess_sprite(pipeline, state.layers, *memory.then, memory.placement, now,
                               std::abs(frame - memory.frame_rendered));
  finish_geometric(pipeline, state.layers, now, assessment.fiducials);
  if (memory.then) assessment.frames_since_render = std::abs(frame - memory.frame_rendered);
  assessment.layer = layer.id;
  assessment.frames_short_of_area = memory.frames_short_of_area;
  assessment.frames_at_rest = memory.rest.frame == frame ? memory.rest.frames : 0;
  see_through_resolution(assessment, memory.resolution);
  assessment.preferences = layer.preferences;
  assessment.in_view = now.touches_display;
  assessment.has_sprite = memory.then.has_value();
  assessment.identical = assessment.identical && !memory.has_old_shadows;
  assess_chunks(pipeline, state, layer_id, frame, assessment);
  if (!assessment.in_view) return assessment;
  const bool must_be_exact = pipeline.settings.regulator.policy == Policy::Budget;
  assessment.cost = must_be_exact ? cost_of(pipeline, state.layers, layer_id,
                                            captured_placement(pipeline, state, layer_id, frame))
                                  : estimated_cost(pipeline, state.layers, now);
  return assessment;
}

}  // namespace talisman::sequences
