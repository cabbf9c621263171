// SPDX-License-Identifier: Apache-2.0
#include "layers/animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talisman::layers {

namespace {

template <typename T>
bool varies(const Keys<T>& keys) {
  const auto differs = [&](const T& v) { return v != keys.values.front(); };
  // A spline between equal keys still swings out where it has slopes.
  const auto slopes = [](const T& v) { return v != 0.0 * v; };
  return std::any_of(keys.values.begin(), keys.values.end(), differs) ||
         (keys.values.size() > 1 &&
          (std::any_of(keys.out_tangents.begin(), keys.out_tangents.end(), slopes) ||
           std::any_of(keys.in_tangents.begin(), keys.in_tangents.end(), slopes)));
}

template <typename T>
void extend_to_keys(const Keys<T>& keys, double& begin_s, double& end_s) {
  if (keys.times_s.empty()) return;
  begin_s = std::min(begin_s, keys.times_s.front());
  end_s = std::max(end_s, keys.times_s.back());
}

/// The time inside the period that shows the same as `t_s`.
double wrapped(double begin_s, double end_s, double t_s) {
  const double period_s = end_s - begin_s, since_s = t_s - begin_s;
  if (!(period_s > 0) || !std::isfinite(period_s) || !std::isfinite(since_s)) return t_s;
  const double rest_s = std::fmod(since_s, period_s);
  return begin_s + (rest_s < 0 ? rest_s + period_s : rest_s);
}

double looped(const TransformTrack& track, double t_s) {
  if (track.loop_end_s > 0) return wrapped(0, track.loop_end_s, t_s);
  double begin_s = HUGE_VAL, end_s = -HUGE_VAL;
  extend_to_keys(track.translation, begin_s, end_s);
  extend_to_keys(track.rotation, begin_s, end_s);
  extend_to_keys(track.scale, begin_s, end_s);
  return wrapped(begin_s, end_s, t_s);
}

Transform moved(const MorphTrack&, const Transform& transform, double) { return transform; }

Transform moved(const TransformTrack& track, Transform transform, double t_s) {
  const double at_s = track.loop ? looped(track, t_s) : t_s;
  if (!track.translation.values.empty()) transform.translation = value_at(track.translation, at_s);
  if (!track.rotation.values.empty()) transform.rotation = value_at(track.rotation, at_s);
  if (!track.scale.values.empty()) transform.scale = value_at(track.scale, at_s);
  return transform;
}

Transform moved(const FlightTrack& track, Transform transform, double t_s) {
  if (track.position.values.empty()) return transform;
  transform.translation = value_at(track.position, t_s);
  dvec3 forward = path_direction(track.position, t_s, false);
  if (!track.target.values.empty()) {
    const dvec3 to_target = value_at(track.target, t_s) - transform.translation;
    if (to_target != dvec3{0, 0, 0}) forward = to_target;
  }
  const double bank_rad = track.bank_rad.values.empty() ? 0 : value_at(track.bank_rad, t_s);
  transform.rotation = look_rotation(forward, path_direction(track.position, t_s, true), bank_rad);
  return transform;
}

Transform moved(const SpinTrack& track, Transform transform, double t_s) {
  const double length = std::hypot(track.axis.x, track.axis.y, track.axis.z);
  const double angle = std::remainder(track.rate_rad_per_s * t_s, 2 * std::numbers::pi);
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(angle)) return transform;
  transform.rotation = unit(transform.rotation) * glm::angleAxis(angle, track.axis / length);
  return transform;
}

bool varying(const TransformTrack& track) {
  return varies(track.translation) || varies(track.rotation) || varies(track.scale);
}
bool varying(const FlightTrack& track) {
  return varies(track.position) ||
         (!track.position.values.empty() && (varies(track.target) || varies(track.bank_rad)));
}
bool varying(const MorphTrack&) { return false; }
bool varying(const SpinTrack& track) { return track.rate_rad_per_s != 0 && track.axis != dvec3{0, 0, 0}; }

double last_key_s(const TransformTrack& track) {
  double begin_s = HUGE_VAL, end_s = 0;
  extend_to_keys(track.translation, begin_s, end_s);
  extend_to_keys(track.rotation, begin_s, end_s);
  extend_to_keys(track.scale, begin_s, end_s);
  return std::max(end_s, track.loop_end_s);
}
double last_key_s(const FlightTrack& track) {
  double begin_s = HUGE_VAL, end_s = 0;
  extend_to_keys(track.position, begin_s, end_s);
  extend_to_keys(track.target, begin_s, end_s);
  extend_to_keys(track.bank_rad, begin_s, end_s);
  return end_s;
}
double last_key_s(const SpinTrack&) { return 0; }
double last_key_s(const MorphTrack& track) {
  double begin_s = HUGE_VAL, end_s = 0;
  for (const Keys<double>& keys : track.weights) extend_to_keys(keys, begin_s, end_s);
  return std::max(end_s, track.loop_end_s);
}

}  // namespace

double looped(const MorphTrack& track, double t_s) {
  if (!track.loop) return t_s;
  if (track.loop_end_s > 0) return wrapped(0, track.loop_end_s, t_s);
  double begin_s = HUGE_VAL, end_s = -HUGE_VAL;
  for (const Keys<double>& keys : track.weights) extend_to_keys(keys, begin_s, end_s);
  return wrapped(begin_s, end_s, t_s);
}

glm::dquat look_rotation(const dvec3& forward, const dvec3& heading, double bank_rad) {
  const double length = std::hypot(forward.x, forward.y, forward.z);
  const bool usable = length >= 1e-300 && std::isfinite(length);
  const dvec3 back = usable ? forward / -length : -heading;
  // Right = forward × up. Straight up or down that is zero, and the heading takes the place of the horizontal
  // part.
  const double horizontal = std::hypot(back.x, back.z);
  const dvec3 ahead = horizontal < 1e-8 ? heading : dvec3{-back.x, 0, -back.z} / horizontal;
  const dvec3 right{-ahead.z, 0, ahead.x};
  const glm::dquat level = glm::quat_cast(dmat3(right, glm::cross(back, right), back));
  const double roll = std::remainder(bank_rad, 2 * std::numbers::pi);
  return unit(std::isfinite(roll) ? level * glm::angleAxis(-roll, dvec3{0, 0, 1}) : level);
}

Transform transform_at(const Track& track, const Transform& without, double t_s) {
  return std::visit([&](const auto& motion) { return moved(motion, without, t_s); }, track.motion);
}

bool moves(const Track& track) {
  return std::visit([](const auto& motion) { return varying(motion); }, track.motion);
}

std::vector<int> moving_carriers(const Scene& scene) {
  std::vector<int> carriers(scene.nodes.size(), -1);
  std::vector<bool> moved(scene.nodes.size(), false);
  for (const Track& track : scene.tracks)
    if (moves(track)) moved.at(track.node) = true;
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    const int parent = scene.nodes[i].parent;
    carriers[i] = moved[i] ? static_cast<int>(i) : parent < 0 ? -1 : carriers.at(parent);
  }
  return carriers;
}

double end_s(const Track& track) {
  return std::visit([](const auto& motion) { return last_key_s(motion); }, track.motion);
}

}  // namespace talisman::layers
