// SPDX-License-Identifier: Apache-2.0
#include "warp/quadrilateral.h"

#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "warp/ceres_reference.h"
#include "warp/conditioning.h"
#include "warp/homography.h"

namespace talisman::warp {
namespace {

using layers::dmat4;
using layers::dvec4;
using layers::LayerState;
using layers::RectD;

using Quad = std::array<dvec3, 4>;

bool is_finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

dvec3 centre_of_bounds(std::span<const dvec3> points) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const dvec3& p : points) lo = glm::min(lo, p), hi = glm::max(hi, p);
  return (lo + hi) / 2.0;
}

/// The rectangle that bounds the points, projected from the eye onto the plane through their centre that
/// faces the eye.
std::optional<Quad> facing_rectangle(const LayerState& state) {
  const dmat4& world_from_camera = state.camera.world_from_camera;
  const dvec3 eye = dvec3(world_from_camera[3]), centre = centre_of_bounds(state.world_points);
  const double distance = glm::length(centre - eye);
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
  const dvec3 forward = (centre - eye) / distance, camera_up = dvec3(world_from_camera[1]);
  dvec3 right = glm::cross(forward, camera_up);
  if (!(glm::length(right) > 0)) return std::nullopt;
  right = glm::normalize(right);
  const dvec3 up = glm::cross(right, forward);
  RectD bounds;
  for (const dvec3& p : state.world_points) {
    const dvec3 ray = p - eye;
    const double depth = glm::dot(ray, forward);
    if (!(depth > state.camera.near_m)) return std::nullopt;
    bounds.include(dvec2{glm::dot(ray, right), glm::dot(ray, up)} * (distance / depth));
  }
  const auto corner = [&](double x, double y) { return centre + x * right + y * up; };
  return Quad{corner(bounds.lo.x, bounds.lo.y), corner(bounds.hi.x, bounds.lo.y),
              corner(bounds.hi.x, bounds.hi.y), corner(bounds.lo.x, bounds.hi.y)};
}

/// Eigen's Umeyama on points relative to their centres, in units of the size then.
Quad carried_along(const Quad& corners, std::span<const dvec3> then, std::span<const dvec3> now) {
  const dvec3 then_centre = centre_of_bounds(then), now_centre = centre_of_bounds(now);
  double unit = 0;
  for (const dvec3& p : then) unit = std::fmax(unit, glm::length(p - then_centre));
  if (!(unit > 0)) unit = 1;
  Eigen::Matrix3Xd from(3, then.size()), to(3, then.size());
  for (std::size_t i = 0; i < then.size(); ++i) {
    const dvec3 a = (then[i] - then_centre) / unit, b = (now[i] - now_centre) / unit;
    from.col(static_cast<Eigen::Index>(i)) << a.x, a.y, a.z;
    to.col(static_cast<Eigen::Index>(i)) << b.x, b.y, b.z;
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(from, to);
  Quad moved;
  for (int k = 0; k < 4; ++k) {
    const dvec3 a = (corners[k] - then_centre) / unit;
    const Eigen::Vector4d b = similarity * Eigen::Vector4d(a.x, a.y, a.z, 1);
    moved[k] = now_centre + unit * dvec3(b.x(), b.y(), b.z());
  }
  return moved;
}

std::optional<std::array<dvec2, 4>> on_display(const Quad& corners, const LayerState& state) {
  const dmat4 clip_from_world = layers::clip_from_world(state.camera, state.view.display_px);
  std::array<dvec2, 4> screen;
  for (int k = 0; k < 4; ++k) {
    const dvec4 clip = clip_from_world * dvec4(corners[k], 1);
    if (!is_finite(dvec3(clip)) || !(clip.w > state.camera.near_m)) return std::nullopt;
    screen[k] = layers::screen_from_clip(clip, state.view.display_px);
  }
  if (first_bad_point(screen) >= 0) return std::nullopt;
  return screen;
}

std::optional<Warp> quadrilateral_warp(const LayerState& then, const LayerState& now) {
  if (then.world_points.empty() || then.world_points.size() != now.world_points.size()) return std::nullopt;
  const auto corners = facing_rectangle(then);
  if (!corners) return std::nullopt;
  const auto before = on_display(*corners, then);
  const auto after = on_display(carried_along(*corners, then.world_points, now.world_points), now);
  if (!before || !after) return std::nullopt;
  const Spread spread = spread_of(*before);
  if (strength(Family::Perspective, spread) < 1) return std::nullopt;
  const FitResult exact = fit_homogeneous(*before, *after, spread);  // four pairs: no error is left
  if (exact.status != FitStatus::Converged || !acceptable(exact.warp, *before)) return std::nullopt;
  return exact.warp;
}

}  // namespace

FitResult fit_shade(const LayerState& then, const LayerState& now, const layers::Correspondences& matched) {
  FitResult fallback = fit(matched.then_px, matched.now_px, Curve::pers);
  const bool has_enough = static_cast<int>(matched.then_px.size()) >= points_needed(Family::Perspective);
  if (!has_enough || fallback.status == FitStatus::NotFinite) return fallback;
  if (fallback.warp.family == Family::Perspective) return fallback;  // at rest: the identity
  const auto warp = quadrilateral_warp(then, now);
  if (!warp || !acceptable(*warp, matched.then_px)) return fallback;
  FitResult result{FitStatus::Converged, *warp};
  measure(matched.then_px, matched.now_px, result);
  return result;
}

FitResult fit(const LayerState& then, const LayerState& now, const layers::Correspondences& matched,
              Curve curve, const FitOptions& options) {
  if (curve == Curve::pers) return fit_shade(then, now, matched);
  if (curve != Curve::pers2) return fit(matched.then_px, matched.now_px, curve, options);
  FitResult plain = fit(matched.then_px, matched.now_px, curve, options);
  const FitResult start = fit_shade(then, now, matched);
  if (start.status != FitStatus::Converged || plain.max_px == 0) return plain;
  FitResult refined = ceres_post_divide(matched.then_px, matched.now_px, start.warp);
  if (!acceptable(refined.warp, matched.then_px)) return plain;
  measure(matched.then_px, matched.now_px, refined);
  // The descent from the quadrilateral may end in another valley than that from the affine warp; the lower
  // one is meant.
  return plain.status == FitStatus::Converged && plain.rms_px < refined.rms_px ? plain : refined;
}

}  // namespace talisman::warp
