// SPDX-License-Identifier: Apache-2.0
// Bounding polyhedra and the depth of convex bodies: supports in 2,000 directions in long double, Euler's formula, and
// boxes, whose depth and distance have closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <glm/geometric.hpp>

#include "layers/convex.h"
#include "layers/polyhedron.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using layers::BoundKind;
using layers::Polyhedron;
using PointSet = std::vector<dvec3>;

constexpr BoundKind kKinds[] = {BoundKind::Box8, BoundKind::Dop14, BoundKind::Dop26};

Exact exact_dot(const dvec3& a, const dvec3& b) {
  return Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z;
}

Exact support_along(const PointSet& points, const dvec3& n) {
  Exact most = -HUGE_VALL;
  for (const dvec3& p : points) {
    const Exact along = exact_dot(p, n);
    if (!(along <= most)) most = along;
    if (std::isnan(along)) break;
  }
  return most;
}

dvec3 any_direction(Random& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const double length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length <= 1) return dvec3(x, y, z) / length;
  }
}

double extent_of(const PointSet& points) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const dvec3& p : points) lo = glm::min(lo, p), hi = glm::max(hi, p);
  const dvec3 size = hi - lo;
  return std::max({size.x, size.y, size.z});
}

/// How far a point lies outside of the polyhedra of all kinds, relative to `scale`.
HardOutcome contains_all(const PointSet& points, double scale) {
  Random random(5);
  Exact worst = 0;
  bool empty = false;
  for (const BoundKind kind : kKinds) {
    const Polyhedron hull = layers::bounding_polyhedron(points, kind);
    if ((empty = hull.points.empty())) continue;
    for (int i = 0; i < 2000; ++i) {
      const dvec3 n = any_direction(random);
      worst = worse(worst, (support_along(points, n) - support_along(hull.points, n)) / scale);
    }
  }
  return {double(worst), empty};
}

PointSet scattered(int count, const dvec3& half, const dvec3& centre) {
  Random random(6);
  PointSet points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    points.push_back(centre + half * dvec3(x, y, z));
  }
  return points;
}

void add_bounds(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const PointSet& points,
                       double scale = 0, double most = 1e-9, bool refused = false) {
    if (scale == 0) scale = extent_of(points);
    cases.push_back({HardStage::Polyhedra,
                     name,
                     special,
                     extreme,
                     {most, "of the extent", "supports, long double", refused},
                     [points, scale] { return contains_all(points, scale); }});
  };
  add("one point", "no extent at all", 1, {{3, -4, 5}}, 1);
  add("1000 times one point", "no extent at all, many times", 1e3, PointSet(1000, {3, -4, 5}), 1);
  add("a line", "no area", 1, scattered(50, {2, 0, 0}, {1, 1, 1}));
  add("a plane", "no volume", 1, scattered(50, {2, 0, 3}, {1, 1, 1}));
  add("needle 1e9 : 1", "1e3 m long, 1e-6 m thick", 1e9, scattered(200, {1e3, 1e-6, 1e-6}, {0, 0, 0}));
  add("1e-6 m", "a grain", 1e-6, scattered(200, dvec3(1e-6), {0, 0, 0}));
  add("1e12 m", "a planetary system", 1e12, scattered(200, dvec3(1e12), {0, 0, 0}));
  add("1e-30 m", "squares vanish in float", 1e-30, scattered(200, dvec3(1e-30), {0, 0, 0}));
  add("1 m at 1e9 m", "7 digits are left", 1e9, scattered(200, dvec3(1), {1e9, -1e9, 1e9}), 0, 1e-6);
  PointSet poisoned = scattered(20, dvec3(1), {0, 0, 0});
  poisoned[7].y = std::numeric_limits<double>::quiet_NaN();
  add("not a number", "one coordinate without a meaning", 1, poisoned, 1, 0, true);
}

/// Each edge of the triangles once in each direction, and corners - edges + faces = 2: what is not so, over all kinds.
HardOutcome closed_surfaces() {
  int wrong = 0;
  for (const BoundKind kind : kKinds) {
    std::set<std::pair<int, int>> edges;
    std::set<int> corners;
    int triangles = 0;
    for (const std::array<int, 3>& t : layers::topology(kind)) {
      ++triangles;
      for (int i = 0; i < 3; ++i) corners.insert(t[i]), wrong += !edges.insert({t[i], t[(i + 1) % 3]}).second;
    }
    for (const auto& [a, b] : edges) wrong += edges.count({b, a}) == 0;
    wrong += int(corners.size()) - int(edges.size()) / 2 + triangles != 2;
  }
  return {double(wrong), false};
}

/// Outer areas of a closed surface add up to nothing (Gauss): the length of their sum over the sum of their lengths.
HardOutcome areas_close(const PointSet& points) {
  double worst = 0;
  for (const BoundKind kind : kKinds) {
    const Polyhedron hull = layers::bounding_polyhedron(points, kind);
    const layers::dmat4 world(1.0);
    Exact sum[3] = {0, 0, 0}, total = 0;
    for (const dvec3& area : layers::face_areas(hull.points, hull, {&world, 1})) {
      for (int k = 0; k < 3; ++k) sum[k] += area[k];
      total += std::sqrt(exact_dot(area, area));
    }
    worst = worse(worst, double(std::hypot(sum[0], sum[1], sum[2]) / total));
  }
  return {worst, false};
}

// --- Depth

struct AlignedBox {
  dvec3 centre, half;
  PointSet corners() const {
    PointSet points;
    for (int k = 0; k < 8; ++k)
      points.push_back(centre + half * dvec3{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1});
    return points;
  }
};

/// Of boxes along the axes: the least overlap of an axis, or minus the distance.
Exact exact_depth(const AlignedBox& a, const AlignedBox& b) {
  Exact least = HUGE_VALL, squared = 0;
  for (int k = 0; k < 3; ++k) {
    const Exact overlap = Exact(a.half[k]) + b.half[k] - std::fabs(Exact(a.centre[k]) - b.centre[k]);
    least = std::min(least, overlap);
    if (overlap < 0) squared += overlap * overlap;
  }
  return squared > 0 ? -std::sqrt(squared) : least;
}

/// How far the exact depth lies outside of the stated bounds, relative to the smaller body; a wrong decision counts 1.
HardOutcome depth_against_closed_form(const AlignedBox& a, const AlignedBox& b, double tolerance) {
  const PointSet p = a.corners(), q = b.corners();
  const layers::DepthDecision decision = layers::decide_depth({p}, {q}, tolerance);
  const Exact right = exact_depth(a, b);
  const double size =
      2 * std::min(std::max({a.half.x, a.half.y, a.half.z}), std::max({b.half.x, b.half.y, b.half.z}));
  const Exact off = worse(worse(Exact(0), Exact(decision.lower) - right), right - decision.upper) / size;
  return {decision.deeper == (right > tolerance) ? double(off) : 1.0, false};
}

void add_depths(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const AlignedBox& a,
                       const AlignedBox& b, double tolerance, double most = 1e-9) {
    cases.push_back({HardStage::Polyhedra,
                     name,
                     special,
                     extreme,
                     {most, "of the smaller body", "closed form of boxes"},
                     [a, b, tolerance] { return depth_against_closed_form(a, b, tolerance); }});
  };
  const AlignedBox unit{{0, 0, 0}, dvec3(0.5)};
  add("gap of 1e-9", "two boxes of 1 m side by side", 1e9, unit, {{1 + 1e-9, 0.3, 0.2}, dvec3(0.5)}, 0);
  add("overlap of 1e-9", "two boxes of 1 m, just into each other", 1e9, unit,
      {{1 - 1e-9, 0.3, 0.2}, dvec3(0.5)}, 0);
  add("touching", "depth 0, tolerance 1e-3", 1e3, unit, {{1, 0, 0}, dvec3(0.5)}, 1e-3);
  add("one in the middle of the other", "the origin is the centre", 1, unit, {{0, 0, 0}, dvec3(0.1)}, 1e-3);
  add("1e-3 m in 1e6 m", "a grain in a mountain", 1e9, {{0, 0, 0}, dvec3(1e6)}, {{9e5, 10, 20}, dvec3(1e-3)},
      1e-6, 1e-6);  // an ulp of the large one is 1e-7 of the small one
  add("grains of 1e-6 m", "overlapping by a tenth", 1e-6, {{0, 0, 0}, dvec3(5e-7)},
      {{9e-7, 1e-7, 0}, dvec3(5e-7)}, 1e-9);
  add("planets of 1e9 m", "1e6 m apart", 1e9, {{0, 0, 0}, dvec3(5e8)}, {{1.001e9, 0, 0}, dvec3(5e8)}, 1e6);
  add("flat on flat", "two cards in one place", 1, {{0, 0, 0}, {0.5, 0.5, 0}}, {{0.2, 0, 0}, {0.5, 0.5, 0}},
      1e-3);
}

}  // namespace

std::vector<HardCase> hard_polyhedra() {
  std::vector<HardCase> cases;
  add_bounds(cases);
  cases.push_back({HardStage::Polyhedra,
                   "closed surfaces",
                   "8, 24 and 48 corners",
                   1,
                   {0, "edges", "Euler's formula"},
                   closed_surfaces});
  cases.push_back({HardStage::Polyhedra,
                   "areas of a needle",
                   "1e6 : 1, faces of all sizes",
                   1e6,
                   {1e-9, "of the surface", "Gauss: areas add up to 0"},
                   [] {
                     return areas_close(scattered(100, {1e3, 1e-3, 1e-3}, {5, 6, 7}));
                   }});
  add_depths(cases);
  return cases;
}

}  // namespace talisman::sequences
