// SPDX-License-Identifier: Apache-2.0
#include "layers/predict_kalman.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "layers/placed.h"
#include "layers/predict.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

/// One coordinate: place, velocity, acceleration.
class AxisFilter {
 public:
  AxisFilter(double first, double measured, double jerk)
      : q_(jerk * jerk), r_(measured * measured), x_(first, 0, 0) {
    p_[0][0] = r_, p_[1][1] = 1e4, p_[2][2] = 1e6;  // nothing is known of how it moves
  }

  void pass(double h) {
    const dmat3 f{{1, 0, 0}, {h, 1, 0}, {h * h / 2, h, 1}};  // columns
    x_ = f * x_;
    p_ = f * p_ * glm::transpose(f) + process(h);
  }
  void measure(double z) {
    const dvec3 k = p_[0] / (p_[0][0] + r_);
    x_ += k * (z - x_.x);
    const dvec3 row = {p_[0][0], p_[1][0], p_[2][0]};
    for (int column = 0; column < 3; ++column) p_[column] -= k * row[column];
  }
  double ahead(double h) const { return x_.x + h * x_.y + h * h / 2 * x_.z; }

 private:
  dmat3 process(double h) const {
    const double h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
    return q_ * dmat3{{h5 / 20, h4 / 8, h3 / 6}, {h4 / 8, h3 / 3, h2 / 2}, {h3 / 6, h2 / 2, h}};
  }

  double q_, r_;
  dvec3 x_;
  dmat3 p_{0.0};
};

/// Coordinates of the past; empty where nothing was measured.
using Measured = std::vector<std::optional<dvec3>>;

dvec3 filtered(const Measured& values, double step_s, double horizon_s, double measured, double jerk) {
  dvec3 ahead{0};
  for (int axis = 0; axis < 3; ++axis) {
    std::optional<AxisFilter> filter;
    for (const std::optional<dvec3>& value : values) {
      if (filter) filter->pass(step_s);
      if (!value) continue;
      if (filter)
        filter->measure((*value)[axis]);
      else
        filter.emplace((*value)[axis], measured, jerk);
    }
    ahead[axis] = filter->ahead(horizon_s);  // the last pose is measured
  }
  return ahead;
}

/// The same rotation, by the way round that is nearest to `to`.
dvec3 nearest_way(const dvec3& turn, const dvec3& to) {
  const double angle = glm::length(turn);
  if (angle == 0) return turn;
  const dvec3 axis = turn / angle;
  const double times = std::round((glm::dot(to, axis) - angle) / (2 * std::numbers::pi));
  return times == 0 ? turn : turn + axis * (2 * std::numbers::pi * times);
}

dmat3 exp_of(const dvec3& turn) {
  const double angle = std::hypot(turn.x, turn.y, turn.z);
  return angle == 0 ? dmat3(1.0) : glm::mat3_cast(glm::angleAxis(angle, turn / angle));
}

bool all_equal(std::span<const dmat4> poses) {
  for (const dmat4& pose : poses)
    if (pose != poses.back()) return false;
  return true;
}

}  // namespace

dmat4 predict_kalman(std::span<const dmat4> past, double step_s, double horizon_s, const KalmanNoise& noise) {
  TALISMAN_CHECK(!past.empty());
  const dmat4& last = past.back();
  if (horizon_s == 0 || past.size() == 1 || !is_finite(last) || all_equal(past)) return last;
  const std::optional<Placed> now = placed(last);
  if (!now) return last;
  Measured places(past.size()), turns(past.size());
  dvec3 turn_after{0};
  for (std::size_t k = past.size(); k-- > 0;) {
    const std::optional<Placed> then = is_finite(past[k]) ? placed(past[k]) : std::nullopt;
    if (!then || then->stretch[2][2] * now->stretch[2][2] < 0) continue;
    places[k] = then->origin - now->origin;
    turn_after = nearest_way(rotation_vector(then->rotation * glm::transpose(now->rotation)), turn_after);
    turns[k] = turn_after;
  }
  const dvec3 turn = filtered(turns, step_s, horizon_s, noise.turn_rad, noise.jerk_rad);
  const dvec3 way = filtered(places, step_s, horizon_s, noise.place_m, noise.jerk_m);
  dmat4 predicted(exp_of(turn) * dmat3(last));
  predicted[3] = dvec4(now->origin + way, 1);
  return is_finite(predicted) ? predicted : last;
}

SceneFrame predict_kalman(std::span<const SceneFrame> past, double step_s, double frames_ahead,
                          const KalmanNoise& noise) {
  TALISMAN_CHECK(!past.empty());
  const SceneFrame& now = past.back();
  const SceneFrame& before = past.size() > 1 ? past[past.size() - 2] : now;
  SceneFrame ahead = predict_linear(before, now, frames_ahead);
  std::vector<dmat4> poses(past.size());
  const auto predicted = [&](const auto& pose_of) {
    for (std::size_t k = 0; k < past.size(); ++k) poses[k] = pose_of(past[k]);
    return predict_kalman(poses, step_s, step_s * frames_ahead, noise);
  };
  for (std::size_t n = 0; n < now.world_from_node.size(); ++n)
    if (before.world_from_node[n] != now.world_from_node[n])
      ahead.world_from_node[n] = predicted([n](const SceneFrame& f) { return f.world_from_node[n]; });
  if (before.camera.world_from_camera != now.camera.world_from_camera)
    ahead.camera.world_from_camera =
        predicted([](const SceneFrame& f) { return f.camera.world_from_camera; });
  return ahead;
}

}  // namespace talisman::layers
