// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Swarms before the camera of a small scene, planned into shared buffers and drawn directly.

#include <string>
#include <utility>
#include <vector>

#include "sequences/content/swarm/swarm.h"
#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::sequences::shown_plan {

using regulator::Joining;
using regulator::PlanShape;

inline constexpr int kPlanFrames = 13;  // no multiple of any slice
inline constexpr double kPlanFps = 30;

/// A swarm of which a part moves, before the camera of a small scene.
inline layers::Scene swarm_scene(SwarmContent::Shape shape, double moving, int count = 40) {
  layers::Scene scene = tests::cube_scene();
  scene.parts.clear();
  SwarmContent swarm;
  swarm.shape = shape;
  swarm.count = count;
  swarm.cube_m = 6;
  swarm.moving_percent = moving;
  swarm.seed = 5;
  add_swarm(scene, swarm, kPlanFps, kPlanFrames / kPlanFps);
  return scene;
}

/// Squares in one plane that faces the eye, of which every second moves in it: where they overlap depths are equal.
inline layers::Scene coplanar_scene() {
  layers::Scene scene = swarm_scene(SwarmContent::Shape::Quad, 50);
  for (layers::Node& node : scene.nodes) {
    node.local.translation.z = 0;
    node.local.rotation = glm::dquat(1, 0, 0, 0);
  }
  std::erase_if(scene.tracks, [](const layers::Track& track) {
    return std::holds_alternative<layers::SpinTrack>(track.motion);
  });
  for (layers::Track& track : scene.tracks)
    for (layers::dvec3& at : std::get<layers::TransformTrack>(track.motion).translation.values) at.z = 0;
  layers::Camera& camera = scene.cameras[static_cast<std::size_t>(scene.active_camera)];
  scene.nodes.push_back({"camera", -1, {{0, 0, 9}, {1, 0, 0, 0}, {1, 1, 1}}});
  camera.node = static_cast<int>(scene.nodes.size()) - 1;
  return scene;
}

struct ShownPlan {
  explicit ShownPlan(layers::Scene in) : scene(std::move(in)) {
    layers::LayerSpec spec;
    spec.name = "all";
    spec.part_globs = {"*"};
    layers = layers::factor(scene, {&spec, 1});
    settings.view.display_px = {70, 52};
    settings.render.samples = 1;
    settings.regulator.policy = regulator::Policy::Predictive;
    settings.regulator.thresholds.geometric_px = 0;
    settings.fps = kPlanFps;
    settings.frames = kPlanFrames;
  }
  Pipeline pipeline(const PlanShape& shape, Joining joining) const {
    Settings own = settings;
    own.regulator.lookahead.frames = shape.frames;
    own.regulator.predictive = {shape.children, joining, regulator::MotionNorm::Euclid};
    return make_pipeline(scene, layers, own);
  }
  std::vector<chunker::Frame> direct() const {
    Settings own = settings;
    own.regulator.policy = regulator::Policy::Direct;
    const Pipeline truth = make_pipeline(scene, layers, own);
    const chunker::PreparedScene prepared(scene, own.render);
    std::vector<chunker::Frame> frames;
    for (int f = 0; f < kPlanFrames; ++f) frames.push_back(draw_direct(truth, f, prepared));
    return frames;
  }
  layers::Scene scene;
  layers::LayerSet layers;
  Settings settings;
};

inline bool same_picture(const chunker::Frame& a, const chunker::Frame& b) { return a.pixels == b.pixels; }

}  // namespace talisman::sequences::shown_plan
