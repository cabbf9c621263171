// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/changes.h"

#include <algorithm>
#include <cmath>

#include "layers/shade_state.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;

void add_nodes(const layers::LayerBound& bound, std::vector<bool>& nodes) {
  for (const int node : {bound.node, bound.axes_node})
    if (node >= 0) nodes[node] = true;
  for (const layers::LayerBound& body : bound.bodies) add_nodes(body, nodes);
}

/// By node: does it carry or shape something of the layer's own?
std::vector<bool> own_nodes(const layers::Scene& scene, const Layer& layer, const layers::LayerBound& bound) {
  std::vector<bool> nodes(scene.nodes.size());
  for (const int part : layer.parts) {
    if (scene.parts[part].node >= 0) nodes[scene.parts[part].node] = true;
    if (scene.parts[part].skin < 0) continue;
    for (const int joint : scene.skins[scene.parts[part].skin].joints) nodes[joint] = true;
  }
  if (layer.plane) nodes[layer.plane->node] = true;
  if (layer.rigid_node >= 0) nodes[layer.rigid_node] = true;
  add_nodes(bound, nodes);
  return nodes;
}

bool is_equal(const SceneFrame& a, const SceneFrame& b, std::size_t node) {
  return a.world_from_node[node] == b.world_from_node[node] &&
         (a.morph_weights.empty() || a.morph_weights[node] == b.morph_weights[node]);
}

/// The old frame with those nodes as they are now that are `wanted`; empty where none of them has moved.
std::optional<SceneFrame> with_nodes(const SceneFrame& then, const SceneFrame& now,
                                     const std::vector<bool>& own, bool wanted) {
  std::optional<SceneFrame> mixed;
  for (std::size_t node = 0; node < own.size(); ++node) {
    if (own[node] != wanted || is_equal(then, now, node)) continue;
    if (!mixed) mixed = then;
    mixed->world_from_node[node] = now.world_from_node[node];
    if (!now.morph_weights.empty()) mixed->morph_weights[node] = now.morph_weights[node];
  }
  return mixed;
}

std::optional<SceneFrame> with_camera(const SceneFrame& then, const SceneFrame& now) {
  if (then.camera == now.camera) return std::nullopt;
  SceneFrame mixed = then;
  mixed.camera = now.camera;
  return mixed;
}

std::optional<SceneFrame> with_lights(const SceneFrame& then, const SceneFrame& now) {
  if (then.lights == now.lights) return std::nullopt;
  SceneFrame mixed = then;
  mixed.lights = now.lights;
  return mixed;
}

/// The layer as it is captured in a frame of its run (layer_planning.h), but for an open shutter.
LayerState state_in(const Pipeline& pipeline, const LayerTable& layers, int layer, const SceneFrame& frame,
                    bool with_shades) {
  const layers::FrameCapture capture(frame, pipeline.settings.view);
  const auto is_of_base = [](const Layer& of) { return of.base >= 0 && of.kind != layers::LayerKind::Light; };
  if (!with_shades) {
    const int surface = is_of_base(layers[layer]) ? layers[layer].base : layer;
    LayerState state;
    capture.capture(layers[surface], layers.bound(surface), state);
    return surface == layer ? state : layers::shade_state(state, layers[layer]);
  }
  std::vector<LayerState> states(layers.size());
  for (const Layer& other : layers) {
    if (other.is_aggregate() && other.id != layer) continue;
    if (is_of_base(other))
      states[other.id] = layers::shade_state(states[other.base], other);
    else
      capture.capture(other, layers.bound(other.id), states[other.id]);
  }
  layers::capture_influences(frame, layers.set(), states);
  return std::move(states[layer]);
}

/// The error of one old sprite.
class OldSprite {
 public:
  OldSprite(const Pipeline& pipeline, const LayerTable& layers, const regulator::LayerAssessment& assessment,
            const SceneFrame& then)
      : pipeline_(pipeline),
        layers_(layers),
        assessment_(assessment),
        has_shades_(assessment.fiducials.shade.px > 0),
        then_(state_in(pipeline, layers, assessment.layer, then, has_shades_)) {}

  static double error_of(const Pipeline& pipeline, const regulator::LayerAssessment& assessment) {
    return pipeline.settings.regulator.policy == regulator::Policy::Hold ? assessment.held_geometric_px
                                                                         : assessment.fiducials.geometric.px;
  }

  /// Were the scene like that now; empty: it would not be in view.
  std::optional<double> error_in(const SceneFrame& frame) const {
    const LayerState now = state_in(pipeline_, layers_, assessment_.layer, frame, has_shades_);
    if (!now.touches_display) return std::nullopt;
    return error_of(pipeline_,
                    assess_sprite(pipeline_, layers_, then_, {}, now, assessment_.frames_since_render));
  }

 private:
  const Pipeline& pipeline_;
  const LayerTable& layers_;
  const regulator::LayerAssessment& assessment_;
  bool has_shades_;
  LayerState then_;
};

/// The scene of the instants of one frame's old sprites, each evaluated once.
class Instants {
 public:
  explicit Instants(const Pipeline& pipeline) : pipeline_(pipeline) {}
  const SceneFrame& at(const LastRenders::Render& render) {
    const int known = predicts(pipeline_) ? render.frame : render.instant;
    const auto [entry, is_new] = frames_.try_emplace({known, render.instant});
    if (is_new) entry->second = scene_expected(pipeline_, known, render.instant);
    return entry->second;
  }

 private:
  const Pipeline& pipeline_;
  std::map<std::pair<int, int>, SceneFrame> frames_;
};

void set_amounts(const Pipeline& pipeline, const LayerTable& layers,
                 const regulator::LayerAssessment& assessment, const SceneFrame& then, const SceneFrame& now,
                 Change& change) {
  const std::vector<bool> own =
      own_nodes(pipeline.scene, layers[assessment.layer], layers.bound(assessment.layer));
  const bool has_shades = assessment.fiducials.shade.px > 0;
  struct Cause {
    std::optional<SceneFrame> frame;
    std::optional<double>& px;
  };
  Cause causes[] = {{with_camera(then, now), change.camera_px},
                    {with_nodes(then, now, own, true), change.own_motion_px},
                    {has_shades ? with_lights(then, now) : std::nullopt, change.light_px},
                    {has_shades ? with_nodes(then, now, own, false) : std::nullopt, change.other_layers_px}};
  const auto acted =
      std::count_if(std::begin(causes), std::end(causes), [](const Cause& c) { return c.frame.has_value(); });
  std::optional<OldSprite> sprite;
  if (acted > 1) sprite.emplace(pipeline, layers, assessment, then);
  for (const Cause& cause : causes)
    if (cause.frame) cause.px = sprite ? sprite->error_in(*cause.frame) : change.geometric_px;
  const bool is_whole =
      std::all_of(std::begin(causes), std::end(causes), [](const Cause& c) { return c.px.has_value(); });
  change.separable =
      is_whole && std::fabs(change.sum_px() - change.geometric_px) <= kSumTolerance * change.geometric_px;
}

}  // namespace

std::optional<LastRenders::Render> LastRenders::of(const std::string& layer) const {
  const auto found = renders_.find(layer);
  return found == renders_.end() ? std::nullopt : std::optional(found->second);
}

void LastRenders::note(const FrameReport& report) {
  for (const regulator::LayerDecision& decision : report.plan.decisions)
    if (decision.action == regulator::Action::Rerender)
      renders_[report.layers[decision.layer].name] = {report.frame, decision.depicts_frame};
}

std::vector<Change> changes_in(const Pipeline& pipeline, const FrameReport& report,
                               const LastRenders& before) {
  std::vector<Change> changes;
  std::optional<SceneFrame> now;
  Instants instants(pipeline);
  for (const regulator::LayerAssessment& assessment : report.assessments) {
    if (!assessment.has_sprite || !assessment.in_view) continue;
    const double error_px = OldSprite::error_of(pipeline, assessment);
    if (!(error_px > 0)) continue;
    const std::string& name = report.layers[assessment.layer].name;
    const std::optional<LastRenders::Render> render = before.of(name);
    if (!render) continue;
    if (!now) now = scene_at(pipeline, report.frame);
    Change change{report.frame, name, render->instant, error_px};
    set_amounts(pipeline, report.layers, assessment, instants.at(*render), *now, change);
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace talisman::sequences
