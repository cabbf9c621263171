// SPDX-License-Identifier: Apache-2.0
#include "regulator/projected_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace talisman::regulator {

namespace {

using layers::dvec2;
using layers::dvec4;

/// The extent of a set of numbers.
struct Spread {
  double lo = std::numeric_limits<double>::infinity(), hi = -std::numeric_limits<double>::infinity();
  void add(double value) {
    lo = std::min(lo, value);
    hi = std::max(hi, value);
  }
  double half() const { return 0.5 * (hi - lo); }
};

/// Half the extent of the vertices on the display.
dvec2 half_extent_px(std::span<const dvec4> clip, const DisplayScale& scale) {
  Spread x, y;
  for (const dvec4& p : clip) {
    x.add(p.x / p.w);
    y.add(p.y / p.w);
  }
  return scale.half_px * dvec2(x.half(), y.half());
}

}  // namespace

std::string_view name(MotionNorm norm) { return norm == MotionNorm::Axis ? "axis" : "euclid"; }

DisplayScale::DisplayScale(const layers::CameraState& camera, layers::ivec2 display_px)
    : half_px(0.5 * std::max(display_px.x, 1), 0.5 * std::max(display_px.y, 1)),
      focal_px(half_px.y / std::tan(0.5 * camera.fov_y_rad)) {}

ProjectedMotion projected_motion(std::span<const dvec4> then, std::span<const dvec4> now,
                                 const DisplayScale& scale) {
  ProjectedMotion motion;
  Spread ratio;
  double squared = 0, sum = 0;  // the sum: a maximum takes no notice of what is not a number
  for (std::size_t i = 0; i < then.size(); ++i) {
    const dvec4 &a = then[i], &b = now[i];
    if (!(a.z > -a.w && b.z > -b.w && a.w > 0 && b.w > 0)) return motion;  // behind the near plane, or NaN
    const double over_a = 1 / a.w, over_b = 1 / b.w;
    const double x = scale.half_px.x * std::abs(b.x * over_b - a.x * over_a);
    const double y = scale.half_px.y * std::abs(b.y * over_b - a.y * over_a);
    motion.x_px = std::max(motion.x_px, x);
    motion.y_px = std::max(motion.y_px, y);
    squared = std::max(squared, x * x + y * y);
    sum += x + y;
    ratio.add(b.w / a.w);  // 1 for what rests
  }
  motion.bounded = true;
  if (then.empty()) return motion;
  motion.px = std::sqrt(squared);
  if (ratio.lo < ratio.hi) {
    const double root = std::sqrt(ratio.hi / ratio.lo), share = 2 * (root - 1) / (root + 1);
    const dvec2 more = share * glm::min(half_extent_px(then, scale), half_extent_px(now, scale));
    motion.x_px += more.x;
    motion.y_px += more.y;
    motion.px += std::hypot(more.x, more.y);
  }
  motion.depth_px = scale.focal_px * std::log(std::max(ratio.hi, 1 / ratio.lo));
  motion.bounded = std::isfinite(sum) && std::isfinite(motion.px) && std::isfinite(motion.depth_px);
  return motion;
}

bool is_beyond(const ProjectedMotion& motion, double delta_px, MotionNorm norm) {
  if (!motion.bounded) return true;
  const double across = norm == MotionNorm::Axis ? std::max(motion.x_px, motion.y_px) : motion.px;
  return !(across <= delta_px && motion.depth_px <= delta_px);
}

std::uint8_t sides_outside(std::span<const dvec4> clip) {
  unsigned sides = 0x1f;
  for (const dvec4& p : clip)
    sides &= static_cast<unsigned>(p.x < -p.w) | static_cast<unsigned>(p.x > p.w) << 1 |
             static_cast<unsigned>(p.y < -p.w) << 2 | static_cast<unsigned>(p.y > p.w) << 3 |
             static_cast<unsigned>(p.z < -p.w) << 4;
  return static_cast<std::uint8_t>(sides);
}

}  // namespace talisman::regulator
