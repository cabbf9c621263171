// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Do the points say enough for this family, and is the map that came out one that a sprite may be shown
/// with?
///
/// The rule for points. Let σ₁ ≥ σ₂ be the singular values of the centred points then, σx and σy their
/// spreads along the axes, and m the largest coordinate. A spread carries information only down to the
/// rounding of its coordinates, and relative to the spread across it only down to a ratio at which the last
/// digits decide:
///
///   isotropic      σ₁ / m
///   x/y scale      min(σx, σy) / m  and  min(σx, σy) / max(σx, σy)
///   affine, persp. σ₂ / m           and  σ₂ / σ₁
///
/// Each ratio is turned into a strength 0 … 1: 0 below its lower limit, 1 above its upper limit, a smooth
/// step of the logarithm between. The strength of a family is the smallest of its ratios' strengths. At 0 the
/// family is not used at all; between, the map is blended with that of the next simpler family, so that
/// points that slowly become collinear hand over without a jump.
///
/// The rule for maps. acceptable(): finite; the determinant keeps its sign over the points (no mirror) and
/// the linear part is not flat to kFlattest; perspective denominators at all points are positive and within
/// kSmallestDenominatorRatio of each other.

#include <span>

#include "warp/warp.h"

namespace talisman::warp {

/// Coordinates beyond this count as infinite, so that squares do not overflow and true errors stay below
/// kHugePx.
inline constexpr double kLargestCoordinatePx = 1e25;
/// Limits of the cross ratios (σ₂/σ₁, min/max of σx, σy): none below the first, full above the second. No
/// unit.
inline constexpr double kCollinearRatio = 1e-9, kSpanningRatio = 1e-7;
/// Limits of spread relative to the largest coordinate; about 64 and 4096 units in the last place. No unit.
inline constexpr double kCoincidentRatio = 1.4e-14, kSpreadRatio = 9.1e-13;
/// Smallest ratio of the singular values of a map's linear part. No unit.
inline constexpr double kFlattest = 1e-12;
/// Smallest ratio of two perspective denominators over the points: closer to the horizon a pixel is stretched
/// a million-fold.
inline constexpr double kSmallestDenominatorRatio = 1e-6;
/// A homography whose own rounding moves a point by more than this, px, cannot be written as a 3×3 matrix of
/// doubles: it foreshortens a small sprite strongly very far from the origin. (At coordinates beyond 1e9 px:
/// by more than kSpreadRatio of the coordinate.)
inline constexpr double kLargestRoundingPx = 1e-4;

/// 1, 2, 2, 3, 4: the fewest points that can determine the family.
int points_needed(Family family);

/// Index of the first point that is not finite or beyond kLargestCoordinatePx; -1: none.
int first_bad_point(std::span<const dvec2> points);

/// Centre and spread of a point set.
struct Spread {
  dvec2 centroid{0, 0};
  double sigma_x = 0, sigma_y = 0;  ///< root mean square about the centroid along the axes, px
  double sigma_1 = 0, sigma_2 = 0;  ///< the same along the principal axes, larger first, px
  dvec2 axis{1, 0};                 ///< unit vector of sigma_1
  double largest_coordinate = 0;    ///< px
};
Spread spread_of(std::span<const dvec2> points);

/// 0 … 1, by the rule above; 1 for translation.
double strength(Family family, const Spread& spread);

/// By the rule above, over the points then.
bool acceptable(const Warp& warp, std::span<const dvec2> then_px);

}  // namespace talisman::warp
