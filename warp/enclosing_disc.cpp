// SPDX-License-Identifier: Apache-2.0
#include "warp/enclosing_disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace talisman::warp {
namespace {

// Distances that differ by less are the same distance, relative. A few units in the last place.
constexpr double kSame = 1e-14;
constexpr int kMostRounds = 200;

double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

/// A disc and the points that decide it, with the share of each in the centre: centre = Σ share · point.
struct Candidate {
  dvec2 centre{0, 0};
  double radius = 0;
  int count = 0;
  std::array<dvec2, 3> point{};
  std::array<double, 3> share{};

  bool contains(dvec2 p) const { return glm::length(p - centre) <= radius * (1 + kSame); }
};

Candidate disc_of(dvec2 a) { return {a, 0, 1, {a}, {1}}; }

Candidate disc_of(dvec2 a, dvec2 b) {
  const dvec2 half = 0.5 * (b - a);
  return {a + half, glm::length(half), 2, {a, b}, {0.5, 0.5}};
}

/// The circumscribed disc; none for a triangle without area. Shares are barycentric: one is negative if the
/// angle there is obtuse, and two points then have a smaller disc.
Candidate disc_of(dvec2 a, dvec2 b, dvec2 c) {
  const dvec2 u = b - a, v = c - a;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v), area = cross(u, v);
  const double twice = 2 * area * area;
  if (!(twice > 0)) return {};
  const double beta = vv * (uu - uv) / twice, gamma = uu * (vv - uv) / twice;
  const dvec2 from_a = beta * u + gamma * v;
  return {a + from_a, glm::length(from_a), 3, {a, b, c}, {1 - beta - gamma, beta, gamma}};
}

/// The smallest disc of the active points and p, which is outside theirs and so decides with them. Each
/// candidate is judged by how far it must grow to contain all of them, and none is refused: whether a
/// triangle is obtuse or a point inside is a matter of rounding where triangles are thin or have a right
/// angle.
Candidate smallest_with(const Candidate& active, dvec2 p) {
  Candidate best;
  const auto consider = [&](Candidate c) {
    for (int k = 0; k < active.count; ++k)
      c.radius = std::max(c.radius, glm::length(active.point[k] - c.centre));
    if (c.count > 0 && (best.count == 0 || c.radius < best.radius)) best = c;
  };
  for (int k = 0; k < active.count; ++k) consider(disc_of(p, active.point[k]));
  for (int k = 0; k < active.count; ++k)
    for (int m = 0; m < k; ++m) consider(disc_of(p, active.point[k], active.point[m]));
  return best;
}

dvec2 farthest_from(dvec2 centre, std::span<const dvec2> points) {
  dvec2 farthest = points[0];
  double most = -1;
  for (const dvec2& p : points) {
    const dvec2 d = p - centre;
    const double squared = glm::dot(d, d);
    if (squared > most) {
      most = squared;
      farthest = p;
    }
  }
  return farthest;
}

/// Σ λ r² / Σ λ r less what rounding may have added; see min_max.h, with H the unit matrix.
double lower_bound(const Candidate& active, double upper) {
  double squares = 0, norms = 0;
  dvec2 drift{0, 0};
  for (int k = 0; k < active.count; ++k) {
    const double share = std::max(0.0, active.share[k]);
    const dvec2 r = active.point[k] - active.centre;
    squares += share * glm::dot(r, r);
    norms += share * glm::length(r);
    drift += share * r;
  }
  if (!(norms > 0)) return 0;
  return std::max(0.0, (squares - 4 * upper * glm::length(drift)) / norms * (1 - kSame));
}

EnclosingDisc solve(std::span<const dvec2> points) {
  Candidate active = disc_of(points[0]);
  EnclosingDisc disc;
  for (disc.iterations = 1;; ++disc.iterations) {
    const dvec2 worst = farthest_from(active.centre, points);
    disc.centre = active.centre;
    disc.radius = glm::length(worst - active.centre);
    if (active.contains(worst) || disc.iterations >= kMostRounds) break;
    const Candidate next = smallest_with(active, worst);
    if (!(next.radius > active.radius)) break;  // rounding: the radius can rise no further
    active = next;
  }
  disc.lower = lower_bound(active, disc.radius);
  return disc;
}

}  // namespace

EnclosingDisc smallest_enclosing_disc(std::span<const dvec2> points) {
  if (points.empty()) return {};
  // About the first point, in units of the extent: fourth powers neither overflow nor vanish.
  const dvec2 origin = points[0];
  double extent = 0;
  for (const dvec2& p : points)
    extent = std::max({extent, std::abs(p.x - origin.x), std::abs(p.y - origin.y)});
  if (!(extent > 0)) return {origin, 0, 0, 1};
  int exponent = 0;
  std::frexp(extent, &exponent);
  const double unit = std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
  std::vector<dvec2> local(points.begin(), points.end());
  for (dvec2& p : local) p = (p - origin) / unit;
  EnclosingDisc disc = solve(local);
  disc.centre = origin + unit * disc.centre;
  disc.radius *= unit;
  disc.lower *= unit;
  return disc;
}

}  // namespace talisman::warp
