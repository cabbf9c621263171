// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/predictors.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "layers/check.h"
#include "layers/predict.h"

namespace talisman::sequences {

namespace {

using layers::dmat3;
using layers::dmat4;
using layers::dvec3;

struct Noise {
  double measured;  ///< standard deviation of a pose
  double jerk;      ///< spectral density of the change of acceleration, its root
};
constexpr Noise kOfPlace{2e-4, 50}, kOfRotation{3.5e-4, 300};

/// One coordinate: place, velocity, acceleration.
class AxisFilter {
 public:
  AxisFilter(double first, const Noise& noise)
      : q_(noise.jerk * noise.jerk), r_(noise.measured * noise.measured), x_(first, 0, 0) {
    p_[0][0] = r_, p_[1][1] = 1e4, p_[2][2] = 1e6;  // nothing is known of how it moves
  }

  void add(double z, double h) {
    const dmat3 f = transition(h);
    x_ = f * x_;
    p_ = f * p_ * glm::transpose(f) + process(h);
    const dvec3 k = p_[0] / (p_[0][0] + r_);
    x_ += k * (z - x_.x);
    const dvec3 row = {p_[0][0], p_[1][0], p_[2][0]};
    for (int column = 0; column < 3; ++column) p_[column] -= k * row[column];
  }
  double ahead(double h) const { return x_.x + h * x_.y + h * h / 2 * x_.z; }

 private:
  /// Columns of F.
  static dmat3 transition(double h) { return {{1, 0, 0}, {h, 1, 0}, {h * h / 2, h, 1}}; }
  dmat3 process(double h) const {
    const double h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
    return q_ * dmat3{{h5 / 20, h4 / 8, h3 / 6}, {h4 / 8, h3 / 3, h2 / 2}, {h3 / 6, h2 / 2, h}};
  }

  double q_, r_;
  dvec3 x_;
  dmat3 p_{0.0};
};

dvec3 filtered(std::span<const dvec3> values, double step_s, double horizon_s, const Noise& noise) {
  dvec3 ahead{0};
  for (int axis = 0; axis < 3; ++axis) {
    AxisFilter filter(values[0][axis], noise);
    for (std::size_t k = 1; k < values.size(); ++k) filter.add(values[k][axis], step_s);
    ahead[axis] = filter.ahead(horizon_s);
  }
  return ahead;
}

/// Axis times angle of the shorter way round.
dvec3 log_of(const dmat3& rotation) {
  glm::dquat q = glm::normalize(glm::quat_cast(rotation));
  if (q.w < 0) q = -q;
  const double sine = std::hypot(q.x, q.y, q.z);
  if (sine == 0) return dvec3{0};
  return dvec3(q.x, q.y, q.z) * (2 * std::atan2(sine, q.w) / sine);
}

dmat3 exp_of(const dvec3& turn) {
  const double angle = std::hypot(turn.x, turn.y, turn.z);
  return angle == 0 ? dmat3(1.0) : glm::mat3_cast(glm::angleAxis(angle, turn / angle));
}

dmat4 kalman(std::span<const dmat4> poses, double step_s, double horizon_s) {
  const std::size_t count = std::min<std::size_t>(poses.size(), kFilterPoses);
  std::vector<dvec3> places, turns;
  const dmat3 last(poses.back());
  for (const dmat4& pose : poses.last(count)) {
    // From the last place on: a filter of large numbers would be one of their rounding.
    places.push_back(dvec3(pose[3]) - dvec3(poses.back()[3]));
    turns.push_back(log_of(dmat3(pose) * glm::transpose(last)));
  }
  dmat4 pose(exp_of(filtered(turns, step_s, horizon_s, kOfRotation)) * last);
  pose[3] = layers::dvec4(dvec3(poses.back()[3]) + filtered(places, step_s, horizon_s, kOfPlace), 1);
  return pose;
}

}  // namespace

std::string_view name(PosePredictor predictor) {
  switch (predictor) {
    case PosePredictor::Held:
      return "held";
    case PosePredictor::Linear:
      return "linear";
    case PosePredictor::Kalman:
      return "kalman";
    case PosePredictor::Known:
      return "known";
  }
  return "";
}

dmat4 predicted_pose(std::span<const dmat4> poses, double step_s, double horizon_s, PosePredictor predictor) {
  TALISMAN_CHECK(!poses.empty());
  TALISMAN_CHECK(predictor != PosePredictor::Known);
  if (poses.size() == 1 || horizon_s == 0 || predictor == PosePredictor::Held) return poses.back();
  if (predictor == PosePredictor::Linear)
    return layers::predict_linear(poses[poses.size() - 2], poses.back(), horizon_s / step_s);
  return kalman(poses, step_s, horizon_s);
}

}  // namespace talisman::sequences
