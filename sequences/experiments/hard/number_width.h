// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do float and double make of a world that is far from its origin, or a sprite far from the display's?
///
/// x: the distance from the origin over the size of the thing, 1 … 1e12. y: the error in pixels, against the planted truth in
/// long double. The same formulas in both widths, so that what the width does is told from what the formula does:
///
///   fit, as printed    P P̂ᵀ(P̂P̂ᵀ)⁻¹ of [LS97 4.1] on raw pixels             sprite of 200 px, affine, exact data
///   fit, centred       the same about the centroids, scaled to 1
///   projection, one matrix   p_clip = (P V) p                                 box of 2 m, 8 m before a camera of 1024 px
///   projection, eye first    p_clip = P R (p - e)
///
/// What the data themselves cannot say (a coordinate's own rounding) is in the error of each, since both sides are rounded to
/// the width first. Beside them the tool's own fit and capture.

#include <string>
#include <vector>

namespace talisman::sequences {

struct WidthPoint {
  double ratio = 1;     ///< distance from the origin over size
  double error_px = 0;  ///< not finite where the formula has no answer
};

struct WidthCurve {
  std::string name;
  std::vector<WidthPoint> points;
};

struct WidthCurves {
  std::vector<WidthCurve> fits, projections;
};

/// Cost: milliseconds.
WidthCurves measure_number_widths();

}  // namespace talisman::sequences
