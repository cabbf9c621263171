// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which is the smallest disc that contains all points?
///
///   radius = min_c maxᵢ ‖pᵢ - c‖
///
/// It is decided by at most three of the points. An active set of them grows by the farthest point outside
/// and is reduced, by trying the few possibilities, to those that decide the disc of the four; the radius of
/// the active set rises strictly, so that it ends, and it ends at the optimum because the disc of a subset is
/// never larger. In practice 2 to 6 rounds of O(n), at worst as many as there are triples with different
/// discs; no random order as in Welzl's method, hence the same bytes always.
///
/// With c = Σ λ pᵢ over the active points, λ on the simplex, Σ λ ‖pᵢ - c‖² / Σ λ ‖pᵢ - c‖ bounds the radius
/// from below, as in min_max.h.

#include <span>

#include "layers/geometry2.h"

namespace talisman::warp {

using layers::dvec2;

struct EnclosingDisc {
  dvec2 centre{0, 0};
  double radius = 0;   ///< the largest distance of a point from `centre`: an upper bound of the optimum, px
  double lower = 0;    ///< certified lower bound; within 1e-12 of the radius, relative, px
  int iterations = 0;  ///< rounds
};

/// Points must be finite and below kLargestCoordinatePx (conditioning.h). No points: radius 0 about the
/// origin.
EnclosingDisc smallest_enclosing_disc(std::span<const dvec2> points);

}  // namespace talisman::warp
