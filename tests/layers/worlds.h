// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Worlds of one point cloud and one camera, put together by hand, for the tests and the benchmark of the
/// decision side.

#include <cmath>
#include <random>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/state.h"

namespace talisman::tests {

using layers::dmat4;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;

inline dmat4 moved_by(const dvec3& v) { return glm::translate(dmat4(1.0), v); }
inline dmat4 turned_by(double angle_rad, const dvec3& axis) {
  return glm::rotate(dmat4(1.0), angle_rad, glm::normalize(axis));
}

inline double uniform(std::mt19937& random, double lo, double hi) {
  return lo + (hi - lo) * (random() / 4294967296.0);
}
inline dvec3 uniform3(std::mt19937& random, double lo, double hi) {
  const double x = uniform(random, lo, hi), y = uniform(random, lo, hi);
  return {x, y, uniform(random, lo, hi)};
}
inline dmat4 random_rotation(std::mt19937& random) {
  const double angle = uniform(random, 0, 6.283);
  return turned_by(angle, uniform3(random, -1, 1) + dvec3(1e-3, 0, 0));
}

inline std::vector<dvec3> box_corners(const dvec3& half_size) {
  std::vector<dvec3> corners;
  for (int s = 0; s < 8; ++s) {
    corners.push_back({s & 1 ? half_size.x : -half_size.x, s & 2 ? half_size.y : -half_size.y,
                       s & 4 ? half_size.z : -half_size.z});
  }
  return corners;
}

inline layers::LightState light_of_kind(layers::Light::Kind kind, const dvec3& position,
                                        const dvec3& direction, const layers::vec3& color) {
  layers::LightState light;
  light.kind = kind;
  light.position = position;
  light.direction = direction;
  light.color = color;
  return light;
}
inline layers::LightState sun(const dvec3& direction, const layers::vec3& color = {1, 1, 1}) {
  return light_of_kind(layers::Light::Kind::Directional, {}, glm::normalize(direction), color);
}
inline layers::LightState lamp(const dvec3& position, const layers::vec3& color = {1, 1, 1}) {
  return light_of_kind(layers::Light::Kind::Point, position, {0, -1, 0}, color);
}
inline layers::LightState ambient(const layers::vec3& color) {
  return light_of_kind(layers::Light::Kind::Ambient, {}, {0, -1, 0}, color);
}

/// A cloud of points on one moving node, seen by a camera that looks along -z from the origin unless it is
/// moved.
struct World {
  explicit World(std::vector<dvec3> points, layers::BoundKind kind = layers::BoundKind::Box8) {
    scene.nodes.emplace_back();
    scene.meshes.emplace_back();
    scene.meshes[0].name = "cloud";
    for (const dvec3& p : points) scene.meshes[0].positions.push_back(layers::vec3(p));
    scene.materials.emplace_back();
    scene.parts.push_back({.name = "mover", .node = 0, .mesh = 0, .material = 0, .skin = -1});
    layer.id = 0;
    layer.name = "mover";
    layer.parts = {0};
    layer.rigid_node = 0;
    bound.kind = kind;
    bound.node = 0;
    bound.hull = layers::bounding_polyhedron(points, kind);
    lights.push_back({});
  }

  layers::SceneFrame frame_at(const dmat4& world_from_mover, const layers::CameraState& camera = {}) const {
    layers::SceneFrame frame;
    frame.scene = &scene;
    frame.world_from_node = {world_from_mover};
    frame.camera = camera;
    frame.lights = lights;
    return frame;
  }

  layers::LayerState at(const dmat4& world_from_mover, const layers::CameraState& camera = {}) const {
    return layers::capture(frame_at(world_from_mover, camera), layer, bound, view);
  }

  layers::Scene scene;
  layers::Layer layer;
  layers::LayerBound bound;
  layers::View view;
  std::vector<layers::LightState> lights;
};

/// The default camera moved and turned.
inline layers::CameraState camera_at(const dmat4& world_from_camera) {
  layers::CameraState camera;
  camera.world_from_camera = world_from_camera;
  return camera;
}

}  // namespace talisman::tests
