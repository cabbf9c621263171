// SPDX-License-Identifier: Apache-2.0
#include "sequences/step.h"

#include <chrono>
#include <map>

#include "fiducials/fiducials.h"
#include "layers/check.h"
#include "warp/shade.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;
using layers::SpritePlacement;
using regulator::Action;
using regulator::LayerAssessment;

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double time_of(const Pipeline& pipeline, int frame) { return frame / pipeline.settings.fps; }

LayerState capture_layer(const Pipeline& pipeline, const SceneFrame& scene_frame, const Layer& layer) {
  return layers::capture(scene_frame, layer, pipeline.bounds[layer.id], pipeline.settings.view);
}

std::vector<LayerState> capture_all(const Pipeline& pipeline, const SceneFrame& scene_frame) {
  std::vector<LayerState> states;
  states.reserve(pipeline.layers.layers.size());
  for (const Layer& layer : pipeline.layers.layers)
    states.push_back(capture_layer(pipeline, scene_frame, layer));
  return states;
}

std::vector<int> order_layers(const Pipeline& pipeline, const SceneFrame& scene_frame,
                              const std::vector<LayerState>& states) {
  std::vector<layers::WorldBounds> bounds;
  bounds.reserve(states.size());
  for (const LayerState& state : states) bounds.push_back(layers::bounds_of(state.world_points));
  return layers::back_to_front(layers::dvec3(scene_frame.camera.world_from_camera[3]), pipeline.layers.layers,
                               bounds);
}

/// Where the layer's sprite lies if it is rendered now. Extents grow only where the sprite is to be moved
/// later.
SpritePlacement place_layer(const Pipeline& pipeline, const LayerState& now, const LayerState& soon,
                            double expected_reuse) {
  const Layer& layer = pipeline.layers.layers[now.layer];
  layers::ExtentOptions extents = pipeline.settings.extents;
  extents.expected_reuse_frames = expected_reuse * layer.preferences.share_of_expected_motion;
  layers::PlacementOptions placement = pipeline.settings.placement;
  placement.resolution_scale *= layer.preferences.resolution_scale;
  return layers::place_sprite(now, soon, pipeline.bounds[layer.id].hull, extents, placement);
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

/// The cost before the placement is known: the part of the layer's bounds that is on the display.
regulator::LayerCost estimated_cost(const Layer& layer, const LayerState& now) {
  const layers::RectD display{{0, 0}, layers::dvec2(now.view.display_px)};
  const layers::RectD seen = layers::intersection(now.screen_bounds_px, display);
  const double scale = layer.preferences.resolution_scale;
  return cost_of(layer,
                 {static_cast<int>(seen.width() * scale + 1), static_cast<int>(seen.height() * scale + 1)});
}

LayerAssessment assess_layer(const Pipeline& pipeline, int frame, const LayerMemory& memory,
                             const LayerState& now) {
  const Layer& layer = pipeline.layers.layers[now.layer];
  LayerAssessment assessment;
  assessment.layer = layer.id;
  assessment.preferences = layer.preferences;
  assessment.in_view = now.touches_display;
  assessment.has_sprite = memory.then.has_value();
  if (!assessment.in_view) return assessment;
  assessment.cost = estimated_cost(layer, now);
  if (!assessment.has_sprite) return assessment;

  assessment.frames_since_render = frame - memory.frame_rendered;
  assessment.identical = now.same_pixels(*memory.then);
  const layers::Correspondences matched =
      layers::correspond(*memory.then, now, pipeline.bounds[layer.id].hull);
  assessment.matched_points = matched.overlap ? static_cast<int>(matched.then_px.size()) : 0;
  if (assessment.identical)
    assessment.fitted.status = warp::FitStatus::Converged;  // the identity, without error
  else
    assessment.fitted =
        warp::fit(*memory.then, now, matched, pipeline.settings.curve, pipeline.settings.fit);
  assessment.fiducials = fiducials::assess(*memory.then, now, memory.placement, matched, assessment.fitted);
  for (std::size_t i = 0; i < matched.then_px.size(); ++i)
    assessment.held_geometric_px =
        std::max(assessment.held_geometric_px, glm::distance(matched.then_px[i], matched.now_px[i]));
  return assessment;
}

/// What the policy `reference` would render for this frame: every layer in view, without growth.
std::int64_t reference_pixels(const Pipeline& pipeline, const std::vector<LayerState>& states) {
  std::int64_t pixels = 0;
  for (const LayerState& now : states)
    if (now.touches_display)
      pixels += cost_of(pipeline.layers.layers[now.layer], place_layer(pipeline, now, now, 0).size_px).pixels;
  return pixels;
}

/// For how many frames the new sprite of a layer will probably be moved by a warp: at most what the policy
/// expects, and no more than twice as long as the old one lasted, so that a layer that is drawn every frame
/// is not drawn larger than it needs to be.
double expected_reuse_frames(const Pipeline& pipeline, const LayerMemory& memory, int frame) {
  const double by_policy = regulator::expected_reuse_frames(pipeline.settings.regulator,
                                                            pipeline.settings.extents.expected_reuse_frames);
  return memory.then ? std::min(by_policy, 2.0 * (frame - memory.frame_rendered)) : by_policy;
}

/// Notes every layer that is to be rendered: its state and its placement, drawn or not.
void remember_renders(const Pipeline& pipeline, PipelineState& state, FrameReport& report,
                      std::vector<LayerState>& states) {
  std::optional<SceneFrame>
      soon;  // one frame ahead, for the velocity; evaluated only if some extent can grow
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    if (decision.action != Action::Rerender) continue;
    LayerState& now = states[decision.layer];
    LayerMemory& memory = state.memory[decision.layer];
    const Layer& layer = pipeline.layers.layers[decision.layer];
    const double reuse = expected_reuse_frames(pipeline, memory, report.frame);
    if (reuse > 0 && !soon) soon = pipeline.scene.at(time_of(pipeline, report.frame + 1));
    const SpritePlacement placement =
        place_layer(pipeline, now, reuse > 0 ? capture_layer(pipeline, *soon, layer) : now, reuse);
    decision.cost = cost_of(layer, placement.size_px);
    memory = {std::move(now), placement, report.frame, false};
  }
}

/// The sprites of this frame, back to front, each with the map that puts it in its place.
std::vector<ShownSprite> sprites_shown(const PipelineState& state, const FrameReport& report,
                                       const std::vector<int>& order) {
  std::vector<ShownSprite> shown;
  for (const int layer : order) {
    const regulator::LayerDecision& decision = report.plan.decisions[layer];
    const LayerMemory& memory = state.memory[layer];
    if (decision.action == Action::Drop || memory.placement.empty()) continue;
    shown.push_back({layer, decision.shown_warp.now_from_then * to_mat3(memory.placement.screen_from_sprite),
                     memory.placement.size_px, report.frame - memory.frame_rendered});
  }
  return shown;
}

/// Draws the sprites that this frame shows and the store does not hold yet.
void draw_missing_sprites(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
                          const chunker::PreparedScene& prepared, FrameReport& report) {
  std::map<int, SceneFrame> earlier;  // a sprite planned for an earlier frame is drawn as of that frame
  for (const ShownSprite& sprite : report.shown) {
    LayerMemory& memory = state.memory[sprite.layer];
    if (memory.drawn) continue;
    const bool late = memory.frame_rendered != report.frame;
    if (late && earlier.count(memory.frame_rendered) == 0)
      earlier.emplace(memory.frame_rendered, pipeline.scene.at(time_of(pipeline, memory.frame_rendered)));
    chunker::RenderResult result = chunker::render(
        prepared, late ? earlier.at(memory.frame_rendered) : now, pipeline.layers.layers[sprite.layer].parts,
        pipeline.settings.view.display_px, memory.placement, pipeline.settings.render);
    state.sprites.put(sprite.layer, std::move(result.sprite));
    memory.drawn = true;
    if (late) {
      ++report.late_renders;  // its counters belong to the frame for which it was planned
    } else {
      report.render += result.counters;
      report.render_by_layer[sprite.layer] = result.counters;
    }
  }
}

chunker::CompositeResult composite_shown(const Pipeline& pipeline, const std::vector<ShownSprite>& shown,
                                         const chunker::SpriteStore& sprites) {
  std::vector<chunker::PlacedSprite> placed;
  placed.reserve(shown.size());
  for (const ShownSprite& sprite : shown) {
    chunker::PlacedSprite p;
    p.sprite = sprites.find(sprite.layer);
    p.screen_from_sprite = sprite.screen_from_sprite;
    placed.push_back(p);
  }
  return chunker::composite(placed, pipeline.settings.view.display_px, pipeline.scene.background);
}

/// All parts in one pass of the renderer into one display-sized sprite: the picture without layers.
chunker::CompositeResult draw_in_one_pass(const Pipeline& pipeline, const SceneFrame& scene_frame,
                                          const chunker::PreparedScene& prepared,
                                          chunker::RenderCounters& counters) {
  std::vector<int> parts;
  for (const Layer& layer : pipeline.layers.layers)
    parts.insert(parts.end(), layer.parts.begin(), layer.parts.end());
  SpritePlacement whole_display;
  whole_display.size_px = pipeline.settings.view.display_px;
  const chunker::RenderResult result =
      chunker::render(prepared, scene_frame, parts, pipeline.settings.view.display_px, whole_display,
                      pipeline.settings.render);
  counters += result.counters;
  chunker::PlacedSprite placed;
  placed.sprite = &result.sprite;
  return chunker::composite({&placed, 1}, pipeline.settings.view.display_px, pipeline.scene.background);
}

void draw(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
          const chunker::PreparedScene& prepared, FrameReport& report) {
  chunker::CompositeResult result;
  const Stopwatch render_watch;
  if (pipeline.settings.regulator.policy == regulator::Policy::Direct) {
    result = draw_in_one_pass(pipeline, now, prepared, report.render);
    report.times.render_ms = render_watch.ms();
  } else {
    draw_missing_sprites(pipeline, state, now, prepared, report);
    report.times.render_ms = render_watch.ms();
    const Stopwatch composite_watch;
    result = composite_shown(pipeline, report.shown, state.sprites);
    report.times.composite_ms = composite_watch.ms();
  }
  report.picture = std::move(result.frame);
  report.composite = result.counters;
  report.sprite_bytes = state.sprites.bytes();
}

}  // namespace

Pipeline::Pipeline(const layers::Scene& scene_in, const layers::LayerSet& layers_in,
                   const Settings& settings_in)
    : scene(scene_in), layers(layers_in), settings(settings_in) {
  for (const Layer& layer : layers.layers)
    bounds.push_back(layers::make_layer_bound(scene, layer, settings.bound));
}

FrameReport step(const Pipeline& pipeline, PipelineState& state, int frame,
                 const chunker::PreparedScene* prepared) {
  TALISMAN_CHECK_EQ(state.memory.size(), pipeline.layers.layers.size());
  FrameReport report;
  report.frame = frame;
  report.render_by_layer.resize(state.memory.size());

  // Decide: no pixel is touched up to and including the plan.
  const Stopwatch plan_watch;
  const SceneFrame now = pipeline.scene.at(time_of(pipeline, frame));
  std::vector<LayerState> states = capture_all(pipeline, now);
  const std::vector<int> order = order_layers(pipeline, now, states);
  for (const LayerState& layer_now : states) {
    report.assessments.push_back(assess_layer(pipeline, frame, state.memory[layer_now.layer], layer_now));
    report.layers_assessed += report.assessments.back().in_view && report.assessments.back().has_sprite;
  }
  report.plan = regulator::regulate(frame, report.assessments, pipeline.settings.regulator);
  double bookkeeping_ms = plan_watch.ms();
  report.pixels_reference = reference_pixels(pipeline, states);
  bookkeeping_ms = plan_watch.ms() - bookkeeping_ms;
  remember_renders(pipeline, state, report, states);
  report.shown = sprites_shown(state, report, order);
  report.times.plan_ms = plan_watch.ms() - bookkeeping_ms;  // the yardstick is not part of the plan

  // Execute.
  if (prepared) draw(pipeline, state, now, *prepared, report);
  return report;
}

chunker::Frame draw_direct(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  chunker::RenderCounters ignored;
  return draw_in_one_pass(pipeline, pipeline.scene.at(time_of(pipeline, frame)), prepared, ignored).frame;
}

chunker::Frame draw_reference(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  Pipeline reference = pipeline;
  reference.settings.regulator.policy = regulator::Policy::Reference;
  PipelineState fresh(reference);
  return step(reference, fresh, frame, &prepared).picture;
}

}  // namespace talisman::sequences
