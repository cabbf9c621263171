// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/latency/late_camera.h"

#include <algorithm>

#include <glm/matrix.hpp>

#include "layers/predict.h"
#include "layers/predict_kalman.h"

namespace talisman::sequences {

namespace {

using layers::CameraState;
using layers::dmat4;
using layers::dvec3;
using layers::dvec4;
using layers::Scene;
using regulator::Prediction;

int poses_needed(Prediction prediction) {
  switch (prediction) {
    case Prediction::Known:
    case Prediction::Held:
      return 1;
    case Prediction::Linear:
      return 2;
    case Prediction::Kalman:
      return kTrackedPoses;
  }
  return 1;
}

/// Of a rigid matrix.
dmat4 rigid_inverse(const dmat4& m) {
  const layers::dmat3 back = glm::transpose(layers::dmat3(m));
  dmat4 inverse(back);
  inverse[3] = dvec4(-(back * dvec3(m[3])), 1);
  return inverse;
}

}  // namespace

std::shared_ptr<const Scene> camera_alone(const Scene& scene) {
  auto rig = std::make_shared<Scene>();
  if (scene.cameras.empty()) return rig;
  layers::Camera camera = scene.cameras.at(static_cast<std::size_t>(scene.active_camera));
  std::vector<int> chain;
  for (int node = camera.node; node >= 0; node = scene.nodes[static_cast<std::size_t>(node)].parent)
    chain.push_back(node);
  std::reverse(chain.begin(), chain.end());
  for (std::size_t k = 0; k < chain.size(); ++k) {
    rig->nodes.push_back(scene.nodes[static_cast<std::size_t>(chain[k])]);
    rig->nodes.back().parent = static_cast<int>(k) - 1;
  }
  for (const layers::Track& track : scene.tracks) {
    const auto at = std::find(chain.begin(), chain.end(), track.node);
    if (at == chain.end()) continue;
    rig->tracks.push_back(track);
    rig->tracks.back().node = static_cast<int>(at - chain.begin());
  }
  camera.node = static_cast<int>(chain.size()) - 1;
  rig->cameras.push_back(std::move(camera));
  return rig;
}

CameraState expected_camera(const Scene& rig, double t_s, double known_s, Prediction prediction,
                            const layers::KalmanNoise& noise) {
  CameraState camera = rig.at(t_s).camera;
  if (prediction == Prediction::Known || !(known_s < t_s)) return camera;
  std::vector<dmat4> poses;
  for (int k = poses_needed(prediction) - 1; k >= 0; --k)
    poses.push_back(rig.at(known_s - k * kTrackerStep_s).camera.world_from_camera);
  const double horizon_s = t_s - known_s;
  camera.world_from_camera =
      prediction == Prediction::Held ? poses.back()
      : prediction == Prediction::Linear
          ? layers::predict_linear(poses.front(), poses.back(), horizon_s / kTrackerStep_s)
          : layers::predict_kalman(poses, kTrackerStep_s, horizon_s, noise);
  return camera;
}

int tracked_node(const Scene& scene) {
  if (scene.cameras.empty()) return -1;
  const int own = scene.cameras[static_cast<std::size_t>(scene.active_camera)].node;
  for (int node = own; node >= 0; node = scene.nodes[static_cast<std::size_t>(node)].parent)
    for (const layers::Track& track : scene.tracks)
      if (track.node == node) return node;
  return own;
}

void look_from(layers::SceneFrame& frame, const CameraState& camera) {
  const dmat4 before = frame.camera.world_from_camera;
  frame.camera = camera;
  const Scene& scene = *frame.scene;
  const int carrier = tracked_node(scene);
  if (before == camera.world_from_camera || carrier < 0) return;
  const dmat4 moved = camera.world_from_camera * rigid_inverse(before);
  std::vector<char> is_carried(scene.nodes.size(), 0);
  for (std::size_t node = static_cast<std::size_t>(carrier); node < scene.nodes.size(); ++node) {
    const int parent = scene.nodes[node].parent;
    is_carried[node] =
        static_cast<int>(node) == carrier || (parent >= 0 && is_carried[static_cast<std::size_t>(parent)]);
    if (is_carried[node]) frame.world_from_node[node] = moved * frame.world_from_node[node];
  }
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    const int node = scene.lights[k].node;
    if (node < 0 || !is_carried[static_cast<std::size_t>(node)]) continue;
    layers::LightState& light = frame.lights[k];
    light.position = dvec3(moved * dvec4(light.position, 1));
    light.direction = dvec3(moved * dvec4(light.direction, 0));
  }
}

namespace {

CameraState camera_from(const Pipeline& pipeline, double t_s, double known_s) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  const auto rig = pipeline.rig ? pipeline.rig : camera_alone(pipeline.scene);
  return expected_camera(*rig, t_s, known_s, options.latency.predict, options.kalman);
}

}  // namespace

CameraState camera_known(const Pipeline& pipeline, int known, int frame) {
  const double fps = pipeline.settings.fps;
  return camera_from(pipeline, frame / fps,
                     known / fps - pipeline.settings.regulator.latency.render_ms / 1000);
}

CameraState camera_of_last_warp(const Pipeline& pipeline, int frame) {
  const regulator::LatencyOptions& latency = pipeline.settings.regulator.latency;
  const double t_s = frame / pipeline.settings.fps;
  return camera_from(pipeline, t_s, t_s - std::min(latency.warp_ms, latency.render_ms) / 1000);
}

Pipeline in_time(const Pipeline& pipeline) {
  Pipeline same = pipeline;
  same.settings.regulator.latency = {};
  return same;
}

}  // namespace talisman::sequences
