// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fleet.h"

#include <algorithm>
#include <random>

#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

using layers::dvec3;
using layers::Scene;

constexpr int kKeys = 8;

double uniform(std::mt19937& random, double lo, double hi) {
  return lo + (hi - lo) * (random() / 4294967296.0);
}

dvec3 uniform3(std::mt19937& random, const dvec3& half_size) {
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
  return half_size * dvec3(x, y, uniform(random, -1, 1));
}

/// A closed path through random points about `centre`.
layers::TransformTrack closed_path(std::mt19937& random, const dvec3& centre, const dvec3& reach,
                                   double turn_rad, double period_s) {
  layers::TransformTrack track;
  track.loop = true;
  track.translation.interpolation = layers::Interpolation::CatmullRom;
  for (int key = 0; key <= kKeys; ++key) {
    const double t = period_s * key / kKeys;
    const dvec3 place = centre + uniform3(random, reach);
    const glm::dquat turn = glm::angleAxis(uniform(random, -turn_rad, turn_rad),
                                           glm::normalize(uniform3(random, dvec3(1)) + dvec3(0, 1.5, 0)));
    track.translation.times_s.push_back(t);
    track.translation.values.push_back(key < kKeys ? place : track.translation.values.front());
    track.rotation.times_s.push_back(t);
    track.rotation.values.push_back(key < kKeys ? turn : track.rotation.values.front());
  }
  return track;
}

int add_moving_node(Scene& scene, const std::string& name, layers::TransformTrack track) {
  layers::Node node;
  node.name = name;
  scene.nodes.push_back(node);
  const int index = static_cast<int>(scene.nodes.size()) - 1;
  scene.tracks.push_back({index, std::move(track)});
  return index;
}

}  // namespace

Scene fleet_scene(int layers, unsigned seed, double period_s) {
  std::mt19937 random(seed);
  Scene scene;
  scene.materials.emplace_back();
  layers::Light sun;
  sun.direction = {-1, -2, -1.5};
  scene.lights = {sun};
  layers::Camera camera;
  camera.node = add_moving_node(scene, "camera", closed_path(random, {0, 0, 0}, dvec3(0.3), 0.03, period_s));
  scene.cameras = {camera};
  for (int i = 0; i < layers; ++i) {
    const std::string name = "ship " + std::to_string(i);
    const double depth = uniform(random, 6, 30);
    const dvec3 centre(uniform(random, -0.5, 0.5) * depth, uniform(random, -0.4, 0.4) * depth, -depth);
    const int node = add_moving_node(
        scene, name, closed_path(random, centre, dvec3(0.15, 0.1, 0.1) * depth, 0.6, period_s));
    scene.meshes.push_back(cube_mesh(uniform(random, 0.4, 2)));
    scene.parts.push_back({.name = name,
                           .node = node,
                           .mesh = static_cast<int>(scene.meshes.size()) - 1,
                           .material = 0,
                           .skin = -1});
  }
  return scene;
}

Scene reversed_fleet_scene(int layers, unsigned seed, double period_s) {
  Scene scene = fleet_scene(layers, seed, period_s);
  // The keys are evenly spaced over the period, so only their values change places.
  for (layers::Track& track : scene.tracks) {
    auto& motion = std::get<layers::TransformTrack>(track.motion);
    std::reverse(motion.translation.values.begin(), motion.translation.values.end());
    std::reverse(motion.rotation.values.begin(), motion.rotation.values.end());
  }
  return scene;
}

}  // namespace talisman::tests
