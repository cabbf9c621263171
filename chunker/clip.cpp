// SPDX-License-Identifier: Apache-2.0
#include "chunker/clip.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::chunker {
namespace {

using layers::dvec3;

/// Inside where normal · (X, Y, w) ≥ offset.
struct ClipPlane {
  dvec3 normal;
  double offset;
  double distance(const dvec3& p) const { return normal.x * p.x + normal.y * p.y + normal.z * p.z - offset; }
};

std::array<ClipPlane, 5> planes_of(const ClipRegion& region) {
  const auto [cx, cy] = std::pair{region.center_px.x, region.center_px.y};
  const double g = kGuardBandPx;
  return {ClipPlane{{0, 0, 1}, region.near_w}, ClipPlane{{1, 0, g - cx}, 0}, ClipPlane{{-1, 0, g + cx}, 0},
          ClipPlane{{0, 1, g - cy}, 0}, ClipPlane{{0, -1, g + cy}, 0}};
}

ClipVertex crossing(const ClipVertex& inner, double inner_distance, const ClipVertex& outer,
                    double outer_distance) {
  const double t = inner_distance / (inner_distance - outer_distance);
  return {inner.point + (outer.point - inner.point) * t, inner.weights + (outer.weights - inner.weights) * t};
}

template <typename Distance>
ClippedPolygon cut(const ClippedPolygon& polygon, const Distance& distance) {
  ClippedPolygon result;
  const auto add = [&result](const ClipVertex& v) {
    // Rounding can make a nearly flat polygon cross a plane more than twice; such a sliver covers nothing.
    if (result.count < static_cast<int>(result.vertices.size())) result.vertices[result.count++] = v;
  };
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& a = polygon.vertices[i];
    const ClipVertex& b = polygon.vertices[(i + 1) % polygon.count];
    const double da = distance(a.point), db = distance(b.point);
    if (da >= 0) add(a);
    if (da >= 0 && db < 0) add(crossing(a, da, b, db));
    if (da < 0 && db >= 0) add(crossing(b, db, a, da));
  }
  return result;
}

}  // namespace

double HalfSpace::height(const dvec3& p) const {
  const dvec3 terms = normal * p;
  const double above = ((terms.x + terms.y) + terms.z) - offset;
  const double largest = std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z) + std::abs(offset);
  return std::abs(above) <= kOnPlane * largest ? 0 : above;
}

ClippedPolygon clip_triangle(const std::array<layers::dvec3, 3>& corners, const ClipRegion& region) {
  ClippedPolygon polygon;
  for (int i = 0; i < 3; ++i) {
    dvec3 weights(0);
    weights[i] = 1;
    polygon.vertices[i] = {corners[i], weights};
  }
  polygon.count = 3;
  for (const ClipPlane& plane : planes_of(region)) {
    if (polygon.count < 3) break;
    polygon = cut(polygon, [&](const dvec3& p) { return plane.distance(p); });
  }
  if (region.kept && polygon.count >= 3)
    polygon = cut(polygon, [&](const dvec3& p) { return region.kept->height(p); });
  if (polygon.count < 3) polygon.count = 0;
  return polygon;
}

}  // namespace talisman::chunker
