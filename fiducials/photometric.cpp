// SPDX-License-Identifier: Apache-2.0
#include "fiducials/photometric.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fiducials/lit_places.h"
#include "layers/built_effects.h"
#include "layers/point_shading.h"
#include "warp/color.h"

namespace talisman::fiducials {
namespace {

using layers::dmat3;
using layers::dmat4;
using layers::LayerBound;
using layers::LayerState;
using layers::Light;
using layers::LightState;

constexpr double kWorstAngle = std::numbers::pi;

Photometric no_photometric(std::string_view why) {
  Photometric p;
  p.why_not = why;
  return p;
}

bool is_finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// ---- point-sampled ----

bool faces_eye(const LayerState& state, std::size_t point) {
  return dot(state.world_normals[point], state.eye() - state.world_points[point]) > 0;
}

/// The colours of the points that are seen in one of the states, or of all where none is.
struct SeenColors {
  layers::InlineVector<dvec3, layers::Correspondences::kRoom> then, now;
  layers::InlineVector<int, layers::Correspondences::kRoom> point;
};

/// The characteristic points, and behind them the pairs.
SeenColors seen_colors(const LayerState& then, const LayerState& now, const std::vector<LitPair>& pairs) {
  SeenColors seen;
  const std::size_t count = now.point_colors.size();
  seen.then.reserve(count), seen.now.reserve(count), seen.point.reserve(count);
  for (const bool all : {false, true}) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!all && !faces_eye(then, i) && !faces_eye(now, i)) continue;
      seen.then.push_back(then.point_colors[i]);
      seen.now.push_back(now.point_colors[i]);
      seen.point.push_back(static_cast<int>(i));
    }
    if (!seen.point.empty()) break;
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    seen.then.push_back(pairs[k].then_color);
    seen.now.push_back(pairs[k].now_color);
    seen.point.push_back(static_cast<int>(count + k));
  }
  return seen;
}

warp::ColorFit fit(const SeenColors& seen, const PhotometricOptions& options) {
  // What the compositor can apply is at most 1. Where nothing may be fitted, black is fitted by anything.
  if (options.color_warp) return warp::fit_color(seen.then, seen.now, {.largest_multiplier = 1});
  warp::ColorFit identity;
  for (std::size_t i = 0; i < seen.then.size(); ++i) {
    const double error = glm::length(seen.now[i] - seen.then[i]);
    if (identity.worst_point >= 0 && !(error > identity.max)) continue;
    identity.max = error;
    identity.worst_point = static_cast<int>(i);
  }
  return identity;
}

/// A characteristic point as it is shaded in the two states.
LitPair pair_at(const LayerState& then, const LayerState& now, int point) {
  const auto at = [point](const LayerState& s) {
    return layers::SurfacePoint{s.world_points[point], s.world_normals[point], s.eye()};
  };
  return {at(then), at(now)};
}

void sample_points(const LayerState& then, const LayerState& now, const LayerBound& bound,
                   const PhotometricOptions& options, Photometric& result) {
  const std::vector<LitPair> pairs = lit_pairs(then, now, bound);
  const SeenColors seen = seen_colors(then, now, pairs);
  const warp::ColorFit fitted = fit(seen, options);
  result.multiplier = fitted.multiplier;
  if (!(fitted.max > 0)) return;
  result.color = fitted.max;
  result.point = seen.point[fitted.worst_point];
  const int beyond = result.point - static_cast<int>(now.point_colors.size());
  const LitPair worst = beyond >= 0 ? pairs[beyond] : pair_at(then, now, result.point);
  result.where_px = place_on_display(now, worst.now.position);
  result.color_light.index =
      light_that_changed(then, now, *bound.surface, worst.then, worst.now, fitted.multiplier);
}

// ---- light source ----

/// The middle and the size of a body's points.
struct Ball {
  dvec3 middle{0, 0, 0};
  double radius = 0;
};

Ball ball_around(std::span<const dvec3> points) {
  Ball ball;
  for (const dvec3& p : points) ball.middle += p;
  ball.middle *= 1 / static_cast<double>(points.size());
  double squared = 0;
  for (const dvec3& p : points) squared = std::max(squared, dot(p - ball.middle, p - ball.middle));
  ball.radius = std::sqrt(squared);
  return ball;
}

/// How a body has moved since `then`.
struct BodyMotion {
  Ball then, now;
  bool turned = false;
  dmat3 turn{1.0};

  dvec3 carried(const dvec3& offset) const { return turned ? turn * offset : offset; }
  double radius() const { return std::max(then.radius, now.radius); }
};

BodyMotion motion_of(const LayerState& then, const LayerState& now, std::size_t body) {
  const std::size_t count = now.world_points.size() / now.world_from_body.size();
  const auto points_of = [&](const LayerState& s) {
    return std::span(s.world_points).subspan(body * count, count);
  };
  BodyMotion motion{ball_around(points_of(then)), ball_around(points_of(now))};
  const dmat3 from(then.world_from_body[body]), to(now.world_from_body[body]);
  if (from == to) return motion;  // exactly nothing, where the inverse would round
  motion.turned = std::isfinite(1 / glm::determinant(from));
  if (motion.turned) motion.turn = to * glm::inverse(from);
  return motion;
}

double relative_change(double a, double b) {
  const double larger = std::max(a, b);
  return larger > 0 && std::isfinite(larger) ? std::fabs(a - b) / larger : 0;
}

void note_angle(double angle_rad, int light, Photometric& result) {
  if (!(angle_rad > result.light_angle_rad)) return;
  result.light_angle_rad = angle_rad;
  result.angle_light.index = light;
}

void note_position(const BodyMotion& motion, const dvec3& then_at, const dvec3& now_at, int light,
                   Photometric& result) {
  const dvec3 before = motion.carried(then_at - motion.then.middle), after = now_at - motion.now.middle;
  note_angle(position_change_rad(before, after, motion.radius()), light, result);
  if (light != LightRef::kEye)
    result.light_distance =
        std::max(result.light_distance, relative_change(glm::length(before), glm::length(after)));
}

bool is_black(const LightState& light) { return light.color == layers::vec3(0, 0, 0); }

/// A light that is not finite is not there (layers/point_shading.h).
bool is_there(const LightState& light) {
  return is_finite(light.position) && is_finite(light.direction) && is_finite(dvec3(light.color)) &&
         !is_black(light);
}

void note_light(const BodyMotion& motion, const LightState& then, const LightState& now, int light,
                Photometric& result) {
  if (!is_there(then) && !is_there(now)) return;
  if (is_there(then) != is_there(now) || then.kind != now.kind) return note_angle(kWorstAngle, light, result);
  if (now.kind == Light::Kind::Ambient) return;
  if (now.kind == Light::Kind::Directional)
    return note_angle(angle_between_rad(motion.carried(then.direction), now.direction), light, result);
  if (now.kind == Light::Kind::Spot)
    note_angle(angle_between_rad(motion.carried(then.direction), now.direction), light, result);
  note_position(motion, then.position, now.position, light, result);
}

void follow_lights(const LayerState& then, const LayerState& now, const LayerBound& bound,
                   Photometric& result) {
  LightState dark;
  dark.color = {0, 0, 0};
  for (std::size_t body = 0; body < now.world_from_body.size(); ++body) {
    const BodyMotion motion = motion_of(then, now, body);
    for (std::size_t l = 0; l < std::max(then.lights.size(), now.lights.size()); ++l) {
      note_light(motion, l < then.lights.size() ? then.lights[l] : dark,
                 l < now.lights.size() ? now.lights[l] : dark, static_cast<int>(l), result);
    }
    if (bound.surface->has_specular()) note_position(motion, then.eye(), now.eye(), LightRef::kEye, result);
  }
}

}  // namespace

double angle_between_rad(const dvec3& a, const dvec3& b) {
  // In units of their largest entries: no product over- or underflows.
  const auto largest = [](const dvec3& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  };
  const dvec3 u = a / largest(a), v = b / largest(b);  // NaN without length
  const double angle = std::atan2(glm::length(cross(u, v)), dot(u, v));
  return angle <= kWorstAngle ? angle : kWorstAngle;
}

double position_change_rad(const dvec3& then_offset, const dvec3& now_offset, double radius) {
  if (then_offset == now_offset) return 0;
  const double nearer = std::min(glm::length(then_offset), glm::length(now_offset));
  if (nearer >= kCloseRadii * radius && nearer > 0) return angle_between_rad(then_offset, now_offset);
  const double change = glm::distance(then_offset, now_offset) / std::max(radius, nearer);
  return change <= kWorstAngle ? change : kWorstAngle;  // also what is not a number
}

Photometric photometric_of(const LayerState& then, const LayerState& now, const LayerBound& bound,
                           const PhotometricOptions& options) {
  if (!layers::is_built(layers::Effect::ColorWarp) || !bound.surface)
    return no_photometric(bound.surface_why_not);
  if (now.point_colors.empty() || then.point_colors.size() != now.point_colors.size())
    return no_photometric("the layer has no characteristic points");
  Photometric result;
  result.computed = true;
  sample_points(then, now, bound, options, result);
  follow_lights(then, now, bound, result);
  return result;
}

}  // namespace talisman::fiducials
