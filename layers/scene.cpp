// SPDX-License-Identifier: Apache-2.0
#include "layers/scene.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/moving_picture.h"
#include "layers/scene_at.h"

namespace talisman::layers {

namespace {

bool finite(const dmat4& m) {
  double sum = 0;  // any infinity or NaN makes 0 · entry NaN
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) sum += 0 * m[column][row];
  return sum == 0;
}

std::vector<Transform> locals_at(const Scene& scene, double t_s) {
  std::vector<Transform> locals;
  locals.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) locals.push_back(node.local);
  for (const Track& track : scene.tracks) {
    Transform& local = locals.at(track.node);
    local = transform_at(track, local, t_s);
  }
  return locals;
}

std::vector<dmat4> worlds_at(const Scene& scene, double t_s) {
  const std::vector<Transform> locals = locals_at(scene, t_s);
  std::vector<dmat4> worlds;
  worlds.reserve(locals.size());
  for (std::size_t i = 0; i < locals.size(); ++i) {
    const int parent = scene.nodes[i].parent;
    TALISMAN_CHECK_LT(parent, static_cast<int>(i));
    worlds.push_back(world_of_node(parent < 0 ? dmat4(1) : worlds[parent], locals[i]));
  }
  return worlds;
}

dmat4 node_matrix(const std::vector<dmat4>& worlds, int node) {
  return node < 0 ? dmat4(1) : worlds.at(node);
}

/// Unit length, or `otherwise` where `v` has no direction.
dvec3 direction_or(const dvec3& v, const dvec3& otherwise) {
  const double length = std::hypot(v.x, v.y, v.z);
  return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

/// The rigid part of a camera's node: a scale above a camera must not scale its near plane. Looks along the
/// node's −z; its y is up as far as it can be.
dmat4 rigid(const dmat4& m) {
  const dvec3 back = direction_or(dvec3(m[2]), {0, 0, 1});
  dvec3 up = direction_or(dvec3(m[1]), {0, 1, 0});
  if (glm::length(glm::cross(up, back)) < 1e-9)
    up = std::fabs(back.y) < 0.9 ? dvec3{0, 1, 0} : dvec3{1, 0, 0};
  const dvec3 right = glm::normalize(glm::cross(up, back));
  return {dvec4(right, 0), dvec4(glm::cross(back, right), 0), dvec4(back, 0), dvec4(dvec3(m[3]), 1)};
}

double morph_weight_at(const MorphTrack& track, std::size_t target, double at_s, double otherwise) {
  const Keys<double>& keys = track.weights[target];
  return keys.values.empty() ? otherwise : value_at(keys, looped(track, at_s));
}

}  // namespace

dmat4 world_of_node(const dmat4& above, const Transform& local) {
  const dmat4 world = above * local.matrix();
  return finite(world) ? world : above;
}

CameraState camera_at(const Scene& scene, const std::vector<dmat4>& worlds) {
  if (scene.cameras.empty()) return {};
  const Camera& camera = scene.cameras.at(scene.active_camera);
  return {rigid(node_matrix(worlds, camera.node)), camera.fov_y_rad, camera.near_m, camera.far_m};
}

std::vector<std::vector<double>> morph_weights_at(const Scene& scene, double t_s) {
  std::vector<std::vector<double>> weights;
  if (std::none_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.morphs.empty(); }))
    return weights;
  for (const Node& node : scene.nodes) weights.push_back(node.morph_weights);
  for (const Track& track : scene.tracks) {
    const auto* motion = std::get_if<MorphTrack>(&track.motion);
    if (motion == nullptr) continue;
    std::vector<double>& own = weights.at(track.node);
    own.resize(std::max(own.size(), motion->weights.size()), 0);
    for (std::size_t k = 0; k < motion->weights.size(); ++k)
      own[k] = morph_weight_at(*motion, k, t_s, own[k]);
  }
  return weights;
}

LightState light_at(const Light& light, const std::vector<dmat4>& worlds) {
  const dmat4 world = node_matrix(worlds, light.node);
  const dvec3 direction = direction_or(dvec3(world * dvec4(light.direction, 0)), {0, -1, 0});
  return {light.kind,
          dvec3(world * dvec4(light.position, 1)),
          direction,
          light.color,
          light.inner_cone_rad,
          light.outer_cone_rad,
          light.casts_shadow,
          light.shadow,
          light.attenuation,
          light.range_m};
}

dmat4 Transform::matrix() const {
  dmat4 m = glm::mat4_cast(unit(rotation));
  for (int axis = 0; axis < 3; ++axis) m[axis] *= scale[axis];
  m[3] = dvec4(translation, 1);
  return m;
}

SceneFrame Scene::at(double t_s) const {
  TALISMAN_CHECK(std::isfinite(t_s));
  SceneFrame frame;
  frame.scene = this;
  frame.time_s = t_s;
  frame.world_from_node = worlds_at(*this, t_s);
  frame.camera = camera_at(*this, frame.world_from_node);
  frame.lights.reserve(lights.size());
  for (const Light& light : lights) frame.lights.push_back(light_at(light, frame.world_from_node));
  if (is_built(Effect::Morphing)) frame.morph_weights = morph_weights_at(*this, t_s);
  if (is_built(Effect::MovingPicture)) frame.picture_frames = picture_frames_at(*this, t_s);
  return frame;
}

double Scene::duration_s() const {
  double end = 0;
  for (const Track& track : tracks) end = std::max(end, end_s(track));
  return end;
}

double falloff(const LightState& light, double distance_m) {
  const dvec3& a = light.attenuation;
  const double below = a.x + distance_m * (a.y + distance_m * a.z);
  constexpr double kBrightest = 1e12;  // at the lamp itself
  double factor = below > 1 / kBrightest ? 1 / below : kBrightest;
  if (light.range_m > 0) factor *= std::max(0.0, 1 - std::pow(distance_m / light.range_m, 4));
  return factor;
}

bool is_animated(const Scene& scene, int node) {
  for (; node >= 0; node = scene.nodes.at(node).parent)
    for (const Track& track : scene.tracks)
      if (track.node == node && moves(track)) return true;
  return false;
}

}  // namespace talisman::layers
