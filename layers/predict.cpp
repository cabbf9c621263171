// SPDX-License-Identifier: Apache-2.0
#include "layers/predict.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "layers/placed.h"

namespace talisman::layers {
namespace {

/// The rotation from `before` to `now`, repeated `times` times; the shorter way round.
dmat3 repeated(const dmat3& before, const dmat3& now, double times) {
  glm::dquat turn = glm::normalize(glm::quat_cast(now * transpose(before)));
  if (turn.w < 0) turn = -turn;
  const dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = length(axis);
  if (!(sine > 0)) return dmat3(1.0);
  const double angle = 2 * std::atan2(sine, turn.w) * times;
  const dvec3 scaled = axis / sine * std::sin(angle / 2);
  return glm::mat3_cast(glm::dquat(std::cos(angle / 2), scaled.x, scaled.y, scaled.z));
}

dmat3 predicted_stretch(const dmat3& before, const dmat3& now, double ahead) {
  const dmat3 stretch = now + ahead * (now - before);
  for (const int axis : {0, 1, 2})
    if (!(stretch[axis][axis] * now[axis][axis] > 0)) return now;
  return stretch;
}

dvec3 predicted_direction(const dvec3& before, const dvec3& now, double ahead) {
  if (before == now) return now;
  const dvec3 normal = cross(before, now);
  const double sine = length(normal);
  if (!(sine > 0) || !std::isfinite(sine)) return now;
  const double angle = std::atan2(sine, dot(before, now)) * ahead;
  const dvec3 axis = normal / sine;
  return normalize(now * std::cos(angle) + cross(axis, now) * std::sin(angle));
}

LightState predict_light(const LightState& before, const LightState& now, double ahead) {
  LightState light = now;
  if (before.kind != now.kind) return light;
  light.position = now.position + ahead * (now.position - before.position);
  light.direction = predicted_direction(before.direction, now.direction, ahead);
  const vec3 color = now.color + static_cast<float>(ahead) * (now.color - before.color);
  light.color = max(color, vec3(0));
  return light;
}

CameraState predict_camera(const CameraState& before, const CameraState& now, double ahead) {
  CameraState camera = now;
  camera.world_from_camera = predict_linear(before.world_from_camera, now.world_from_camera, ahead);
  const double fov = now.fov_y_rad + ahead * (now.fov_y_rad - before.fov_y_rad);
  if (fov > 0 && fov < std::numbers::pi) camera.fov_y_rad = fov;
  return camera;
}

}  // namespace

dmat4 predict_linear(const dmat4& before, const dmat4& now, double frames_ahead) {
  if (before == now || frames_ahead == 0 || !is_finite(before) || !is_finite(now)) return now;
  const std::optional<Placed> from = placed(before), to = placed(now);
  if (!from || !to || from->stretch[2][2] * to->stretch[2][2] < 0) return now;
  const dmat3 linear = from->rotation == to->rotation && from->stretch == to->stretch
                           ? dmat3(now)
                           : repeated(from->rotation, to->rotation, frames_ahead) * to->rotation *
                                 predicted_stretch(from->stretch, to->stretch, frames_ahead);
  dmat4 predicted(linear);
  predicted[3] = dvec4(to->origin + frames_ahead * (to->origin - from->origin), 1);
  return is_finite(predicted) ? predicted : now;
}

SceneFrame predict_linear(const SceneFrame& before, const SceneFrame& now, double frames_ahead) {
  TALISMAN_CHECK_EQ(before.world_from_node.size(), now.world_from_node.size());
  TALISMAN_CHECK_EQ(before.lights.size(), now.lights.size());
  if (frames_ahead == 0) return now;
  SceneFrame ahead = now;
  ahead.time_s = now.time_s + frames_ahead * (now.time_s - before.time_s);
  for (std::size_t n = 0; n < now.world_from_node.size(); ++n)
    ahead.world_from_node[n] =
        predict_linear(before.world_from_node[n], now.world_from_node[n], frames_ahead);
  ahead.camera = predict_camera(before.camera, now.camera, frames_ahead);
  for (std::size_t l = 0; l < now.lights.size(); ++l)
    ahead.lights[l] = predict_light(before.lights[l], now.lights[l], frames_ahead);
  for (std::size_t n = 0; n < now.morph_weights.size(); ++n)
    for (std::size_t k = 0; k < now.morph_weights[n].size(); ++k)
      ahead.morph_weights[n][k] += frames_ahead * (now.morph_weights[n][k] - before.morph_weights[n][k]);
  return ahead;
}

}  // namespace talisman::layers
