// SPDX-License-Identifier: Apache-2.0
#include "layers/outline.h"

#include <algorithm>

namespace talisman::layers {
namespace {

/// Twice the area of the triangle; > 0 where c is on the positive side of a → b.
double turn(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Extends a chain whose first `fixed` corners belong to an earlier one.
void extend_chain(std::vector<dvec2>& chain, std::size_t fixed, dvec2 p) {
  while (chain.size() > fixed && turn(chain[chain.size() - 2], chain.back(), p) <= 0) chain.pop_back();
  chain.push_back(p);
}

/// Nothing to cut off: the common case, worth a look before a new polygon is made.
bool is_within_side(const std::vector<dvec2>& polygon, int axis, double sign, double limit) {
  return std::all_of(polygon.begin(), polygon.end(),
                     [=](const dvec2& p) { return sign * (p[axis] - limit) >= 0; });
}

/// Keeps the side where sign · coordinate ≥ sign · limit.
std::vector<dvec2> clip_to_side(const std::vector<dvec2>& polygon, int axis, double sign, double limit) {
  std::vector<dvec2> result;
  result.reserve(polygon.size() + 2);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
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

std::vector<dvec2> convex_hull(std::vector<dvec2> points) {
  const auto before = [](dvec2 a, dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<dvec2> chain;
  chain.reserve(points.size() + 1);
  for (const dvec2 p : points) extend_chain(chain, 1, p);
  const std::size_t lower = chain.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) extend_chain(chain, lower, points[i]);
  chain.pop_back();  // the first corner again
  return chain;
}

std::vector<dvec2> clip_to_rect(std::vector<dvec2> polygon, const RectD& rect) {
  const auto cut = [&polygon](int axis, double sign, double limit) {
    if (!is_within_side(polygon, axis, sign, limit)) polygon = clip_to_side(polygon, axis, sign, limit);
  };
  for (const int axis : {0, 1}) {
    cut(axis, 1, rect.lo[axis]);
    cut(axis, -1, rect.hi[axis]);
  }
  return polygon;
}

}  // namespace talisman::layers
