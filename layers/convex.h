// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How deep do two convex bodies reach into each other?
///
///   depth(A, C) = min over unit n of h(n),   h(n) = max over A of a·n - min over C of c·n
///
/// h(n) > 0: a plane across n would have to shift A by h(n) to part them; h(n) ≤ 0: it parts them with the
/// gap -h(n). Bodies are the convex hulls of point sets; no topology is needed, so flat, coincident and
/// repeated points are as good as others.
///
/// The questions of the visibility sort are decisions, "is the depth above a tolerance?", and come with
/// bounds that say by how much the bodies may move before the answer can change:
///
///   lower ≤ depth ≤ upper = h(normal).
///
/// While the bodies are apart: Gilbert, Johnson & Keerthi 1988 on M = A - C, where the closest point of the
/// running simplex bounds the distance from one side and the supporting plane from the other. Once the origin
/// is in the simplex: the expanding polytope of van den Bergen 2001, whose inscribed ball about the origin is
/// the lower bound.

#include <array>
#include <optional>
#include <span>

#include "layers/geometry2.h"

namespace talisman::layers {

/// conv(points ∪ {apex}), or conv(points) without one. Points are relative to an origin near the bodies
/// (rounding errors grow with their magnitude), and finite.
struct ConvexSet {
  std::span<const dvec3> points;
  const dvec3* apex = nullptr;
};

/// Four points of A - C, a[i] - c[i], by the indices of the sets' points; c[i] = kApex is the apex of C.
struct Enclosure {
  static constexpr int kApex = -1;
  std::array<int, 4> a{}, c{};
};

/// How far the origin lies inside of the tetrahedron: a lower bound of the depth. Not above 0 where it is
/// outside, or where the four points are in one plane.
double depth_within(const Enclosure& enclosure, const ConvexSet& a, const ConvexSet& c);

struct DepthDecision {
  bool deeper = false;  ///< depth > tolerance; where rounding leaves it open, true
  bool decided = true;  ///< false: neither bound reached the tolerance
  double lower = 0, upper = 0;
  dvec3 normal{0, 0, 0};  ///< unit, from A to C; h(normal) = upper. Zero for empty sets.
  int iterations = 0;
  /// Where A and C meet: four corners of A - C with the origin between them, which show it without a search
  /// as long as that is so.
  std::optional<Enclosure> enclosure;
};

/// Is depth(A, C) > tolerance (≥ 0)? Goes on after the decision until the bounds are within a fifth
/// of each other or some steps are spent, since a bound that is better lasts for more frames. `guess` is a
/// direction to try first (0: from A's middle to C's). Where the bounds cannot leave room for a motion of
/// `worthwhile` anyway it stops at the decision. An empty set is not deeper than anything. Cost: 4 … 40
/// supports of O(points) each, typically 5.
DepthDecision decide_depth(const ConvexSet& a, const ConvexSet& c, double tolerance,
                           const dvec3& guess = dvec3{0, 0, 0}, double worthwhile = 0);

}  // namespace talisman::layers
