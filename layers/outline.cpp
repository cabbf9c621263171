// SPDX-License-Identifier: Apache-2.0
#include "layers/outline.h"

#include <algorithm>
#include <cmath>

namespace talisman::layers {
namespace {

/// Twice the area of the triangle; > 0 where c is on the positive side of a → b.
double turn(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Extends a chain whose first `fixed` corners belong to an earlier one.
void extend_chain(Polygon2& chain, std::size_t fixed, dvec2 p) {
  while (chain.size() > fixed && turn(chain[chain.size() - 2], chain.back(), p) <= 0) chain.pop_back();
  chain.push_back(p);
}

/// Nothing to cut off: the common case, worth a look before a new polygon is made.
bool is_within_side(const Polygon2& polygon, int axis, double sign, double limit) {
  return std::all_of(polygon.begin(), polygon.end(),
                     [=](const dvec2& p) { return sign * (p[axis] - limit) >= 0; });
}

/// Keeps the side where sign · coordinate ≥ sign · limit.
Polygon2 clip_to_side(const Polygon2& polygon, int axis, double sign, double limit) {
  Polygon2 result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 from = polygon[i], to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double d_from = sign * (from[axis] - limit), d_to = sign * (to[axis] - limit);
    if (d_from >= 0) result.push_back(from);
    if ((d_from >= 0) == (d_to >= 0)) continue;
    dvec2 on_side = from + (to - from) * (d_from / (d_from - d_to));
    on_side[axis] = limit;
    result.push_back(on_side);
  }
  return result;
}

}  // namespace

Polygon2 convex_hull(std::span<const dvec2> points) {
  const auto before = [](dvec2 a, dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  Polygon2 sorted(points);
  std::sort(sorted.begin(), sorted.end(), before);
  sorted.truncate(static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin()));
  if (sorted.size() < 3) return sorted;
  Polygon2 chain;
  chain.reserve(sorted.size() + 1);
  for (const dvec2 p : sorted) extend_chain(chain, 1, p);
  const std::size_t lower = chain.size();
  for (std::size_t i = sorted.size() - 1; i-- > 0;) extend_chain(chain, lower, sorted[i]);
  chain.pop_back();  // the first corner again
  return chain;
}

Polygon2 clip_to_rect(const Polygon2& polygon, const RectD& rect) {
  Polygon2 result = polygon;
  const auto cut = [&result](int axis, double sign, double limit) {
    if (!is_within_side(result, axis, sign, limit)) result = clip_to_side(result, axis, sign, limit);
  };
  for (const int axis : {0, 1}) {
    cut(axis, 1, rect.lo[axis]);
    cut(axis, -1, rect.hi[axis]);
  }
  return result;
}

Polygon2 clip_to_half_plane(const Polygon2& polygon, dvec2 normal, double offset) {
  const auto depth = [&](dvec2 p) { return normal.x * p.x + normal.y * p.y - offset; };
  Polygon2 kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double da = depth(a), db = depth(b);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

double area_of(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) twice += turn(polygon[0], polygon[i], polygon[i + 1]);
  return std::abs(twice) / 2;
}

}  // namespace talisman::layers
