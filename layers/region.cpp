// SPDX-License-Identifier: Apache-2.0
#include "layers/region.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "layers/clip.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
/// Beyond this a box counts as everywhere, so that no product of the test overflows into NaN.
constexpr double kFar = 1e30;
/// Of a sum of four products in double, relative to their sizes.
constexpr double kRounding = 2e-15;

float rounded_down(double v) {
  const auto f = static_cast<float>(v);
  return f <= v ? f : std::nextafter(f, -kLargest);
}
float rounded_up(double v) {
  const auto f = static_cast<float>(v);
  return f >= v ? f : std::nextafter(f, kLargest);
}

bool is_within(double v) { return std::fabs(v) <= kFar; }  // NaN is not

}  // namespace

Box3 box_of(const dvec3& lo, const dvec3& hi) {
  Box3 box;
  for (int k = 0; k < 3; ++k) {
    if (!is_within(lo[k]) || !is_within(hi[k])) return kEverywhere;
    box.lo[k] = rounded_down(lo[k]);
    box.hi[k] = rounded_up(hi[k]);
  }
  return box;
}

Box3 box_of(std::span<const dvec3> points) {
  if (points.empty()) return {};
  dvec3 lo = points.front(), hi = lo;
  double sum = 0;  // a NaN anywhere is one here
  for (const dvec3& p : points) {
    lo = glm::min(lo, p), hi = glm::max(hi, p);
    sum += 0 * p.x + 0 * p.y + 0 * p.z;
  }
  return sum == 0 ? box_of(lo, hi) : kEverywhere;
}

Box3 transformed(const dmat4& m, const Box3& box) {
  if (box.empty()) return box;
  if (box.hi[0] >= kFar || box.lo[0] <= -kFar) return kEverywhere;
  dvec3 lo, hi;
  for (int row = 0; row < 3; ++row) {
    double least = m[3][row], most = least, size = std::fabs(least);
    for (int k = 0; k < 3; ++k) {
      const double a = m[k][row] * box.lo[k], b = m[k][row] * box.hi[k];
      least += std::min(a, b), most += std::max(a, b);
      size += std::max(std::fabs(a), std::fabs(b));
    }
    lo[row] = least - kRounding * size, hi[row] = most + kRounding * size;
    if (std::isnan(least) || std::isnan(most)) return kEverywhere;
  }
  return box_of(lo, hi);
}

Box3 joined(const Box3& a, const Box3& b) {
  Box3 both;
  for (int k = 0; k < 3; ++k)
    both.lo[k] = std::min(a.lo[k], b.lo[k]), both.hi[k] = std::max(a.hi[k], b.hi[k]);
  return both;
}

Box3 intersection(const Box3& a, const Box3& b) {
  Box3 both;
  for (int k = 0; k < 3; ++k)
    both.lo[k] = std::max(a.lo[k], b.lo[k]), both.hi[k] = std::min(a.hi[k], b.hi[k]);
  return both;
}

bool meet(const Box3& a, const Box3& b) { return !intersection(a, b).empty(); }

double half_area(const Box3& box) {
  if (box.empty()) return 0;
  const double x = double(box.hi[0]) - box.lo[0], y = double(box.hi[1]) - box.lo[1],
               z = double(box.hi[2]) - box.lo[2];
  return x * y + y * z + z * x;
}

Region view_region(const CameraState& camera, ivec2 display_px, double margin) {
  const dmat4 clip = clip_from_world(camera, display_px);
  const dvec4 x{clip[0][0], clip[1][0], clip[2][0], clip[3][0]},
      y{clip[0][1], clip[1][1], clip[2][1], clip[3][1]}, w{clip[0][3], clip[1][3], clip[2][3], clip[3][3]};
  const double far_eye = glm::length(dvec3(camera.world_from_camera[3]));
  Region region;
  for (const HalfSpace& h : view_half_spaces(camera.near_m, margin, 0)) {
    const dvec4 row = h.x * x + h.y * y + h.w * w;
    const double on_plane = 4 * kOnPlane * glm::length(dvec3(row)) * far_eye;
    region.push_back({dvec3(row), row.w + h.constant + on_plane});
  }
  return region;
}

double reach_of(std::span<const Box3> boxes) {
  double reach = 0;
  for (const Box3& box : boxes)
    for (int k = 0; k < 3; ++k)
      for (const double v : {double(box.lo[k]), double(box.hi[k])})
        if (is_within(v)) reach = std::max(reach, std::fabs(v));
  return reach;
}

void BoxLanes::put(int lane, const Box3& box) {
  for (int k = 0; k < 3; ++k) side[k][lane] = box.lo[k], side[k + 3][lane] = box.hi[k];
}

Box3 BoxLanes::at(int lane) const {
  Box3 box;
  for (int k = 0; k < 3; ++k) box.lo[k] = side[k][lane], box.hi[k] = side[k + 3][lane];
  return box;
}

RegionTest::RegionTest(std::span<const Plane> region, double reach_m) {
  const auto splat = [](double v) { return Float4{} + static_cast<float>(v); };
  for (const Plane& plane : region) {
    if (count_ == kMostPlanes) break;
    // Of unit length, so that no product of floats leaves their range. What has no direction cuts nothing.
    const dvec3 n = direction_or_zero(plane.normal);
    const double d = plane.offset / glm::dot(n, plane.normal);
    if (n == dvec3(0) || !is_within(d)) continue;
    const double slack = kSlack * (1.8 * reach_m + std::fabs(d));
    Ready& ready = ready_[count_++];
    ready.x = splat(n.x), ready.y = splat(n.y), ready.z = splat(n.z);
    ready.inner = splat(d), ready.outer = splat(d + slack);
    for (int k = 0; k < 3; ++k) {
      ready.far[k] = static_cast<std::uint8_t>(n[k] >= 0 ? k + 3 : k);
      ready.near[k] = static_cast<std::uint8_t>(n[k] >= 0 ? k : k + 3);
    }
  }
}

Side RegionTest::side_of(const Box3& box, PlaneMask& mask) const {
  if (box.empty()) return Side::Outside;
  BoxLanes lanes{};
  lanes.put(0, box);
  for (PlaneMask left = mask; left != 0; left &= left - 1) {
    const int plane = std::countr_zero(left);
    if (outside(plane, lanes) & 1u) return Side::Outside;
    if (inside(plane, lanes) & 1u) mask &= ~(PlaneMask{1} << plane);
  }
  return mask == 0 ? Side::Inside : Side::Cut;
}

}  // namespace talisman::layers
