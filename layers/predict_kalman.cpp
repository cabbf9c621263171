// SPDX-License-Identifier: Apache-2.0
#include "layers/predict_kalman.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "layers/placed.h"
#include "layers/predict.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

/// How (place, velocity, acceleration) goes on over a time, and the covariance that noise of density 1 adds.
struct Course {
  dmat3 step{1.0}, noise{0.0};
};

Course lasting(double h) {
  const double h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
  return {dmat3{{1, 0, 0}, {h, 1, 0}, {h * h / 2, h, 1}},  // columns
          dmat3{{h5 / 20, h4 / 8, h3 / 6}, {h4 / 8, h3 / 3, h2 / 2}, {h3 / 6, h2 / 2, h}}};
}

/// exp(s M) for a time in which little decays: the next term is below rounding.
dmat3 short_step(const dmat3& rates, double s) {
  constexpr int kTerms = 9;
  dmat3 sum(1.0), term(1.0);
  for (int k = 1; k <= kTerms; ++k) {
    term = rates * term * (s / k);
    sum += term;
  }
  return sum;
}

/// Of rates per second at which velocity and acceleration die away, not both 0.
Course dying(double h, double velocity, double acceleration) {
  constexpr double kMost = 1.0 / 64;  // of either, in the time that is doubled
  const int doublings = std::max(0, std::ilogb(h * std::max(velocity, acceleration) / kMost) + 1);
  const double first = std::ldexp(h, -doublings);
  const dmat3 rates{{0, 0, 0}, {1, -velocity, 0}, {0, 1, -acceleration}};
  Course course{short_step(rates, first), dmat3(0.0)};
  constexpr double kNode = 0.7745966692414834;  // √(3/5): Gauss and Legendre, three nodes
  for (const auto& [node, weight] : {std::pair{-kNode, 5.0 / 18}, {0.0, 8.0 / 18}, {kNode, 5.0 / 18}}) {
    const dvec3 g = short_step(rates, first * (1 + node) / 2)[2];
    course.noise += glm::outerProduct(g, g) * (weight * first);
  }
  for (int k = 0; k < doublings; ++k) {
    course.noise += course.step * course.noise * glm::transpose(course.step);
    course.step = course.step * course.step;
  }
  return course;
}

Course course_over(double h, const KalmanNoise& noise) {
  if (noise.coast_s == 0 && noise.push_s == 0) return lasting(h);
  const auto rate = [](double lasts_s) { return lasts_s > 0 ? 1 / lasts_s : 0; };
  return dying(h, rate(noise.coast_s), rate(noise.push_s));
}

/// One coordinate: place, velocity, acceleration.
class AxisFilter {
 public:
  AxisFilter(double first, double measured) : r_(measured * measured), x_(first, 0, 0) {
    p_[0][0] = r_, p_[1][1] = 1e4, p_[2][2] = 1e6;  // nothing is known of how it moves
  }

  void pass(const dmat3& step, const dmat3& noise) {
    x_ = step * x_;
    p_ = step * p_ * glm::transpose(step) + noise;
  }
  void measure(double z) {
    const dvec3 k = p_[0] / (p_[0][0] + r_);
    x_ += k * (z - x_.x);
    const dvec3 row = {p_[0][0], p_[1][0], p_[2][0]};
    for (int column = 0; column < 3; ++column) p_[column] -= k * row[column];
  }
  double ahead(const dmat3& step) const { return x_.x * step[0][0] + step[1][0] * x_.y + step[2][0] * x_.z; }

 private:
  double r_;
  dvec3 x_;
  dmat3 p_{0.0};
};

/// Coordinates of the past; empty where nothing was measured.
using Measured = std::vector<std::optional<dvec3>>;

/// From one pose to the next, and from the last one to what is asked for.
struct Courses {
  Course between, ahead;
};

dvec3 filtered(const Measured& values, const Courses& courses, double measured, double jerk) {
  dvec3 ahead{0};
  const dmat3 noise = jerk * jerk * courses.between.noise;
  for (int axis = 0; axis < 3; ++axis) {
    std::optional<AxisFilter> filter;
    for (const std::optional<dvec3>& value : values) {
      if (filter) filter->pass(courses.between.step, noise);
      if (!value) continue;
      if (filter)
        filter->measure((*value)[axis]);
      else
        filter.emplace((*value)[axis], measured);
    }
    ahead[axis] = filter->ahead(courses.ahead.step);  // the last pose is measured
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
  const dvec3 turn = filtered(turns, {course_over(step_s, noise), course_over(horizon_s, noise)},
                              noise.turn_rad, noise.jerk_rad);
  const dvec3 way = filtered(places, {lasting(step_s), lasting(horizon_s)}, noise.place_m, noise.jerk_m);
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
