// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does an independent solver answer?
///
/// Ceres solves the same problems with other methods: all unknowns at once, derivatives by automatic
/// differentiation, a trust region. It is the oracle of the fits in this folder and the solver of the curve
/// `pers2`; it costs ten times their time and more. Everything happens in normalised coordinates
/// (homography.h).

#include <span>

#include "warp/fit.h"

namespace talisman::warp {

/// minimise Σ ‖W(p̂ᵢ) - pᵢ‖² over the perspective warps, from `start` (any family, acceptable over the
/// points). Status Converged, NotConverged, or Degenerate where the points have no spread. Errors are not
/// filled in. Cost: 25 µs at 14 points, more far from the optimum.
FitResult ceres_post_divide(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Warp& start);

/// minimise maxᵢ ‖W(p̂ᵢ) - pᵢ‖ over `family` by continuation: Σ ‖rᵢ‖ᵖ for p = 2, 4, … 2^log2_p, each from the
/// last. Ends about 2^(ln n / p) too high: 0.3 … 0.5 % at the default [A §5]. The sum of squares is log2_p
/// = 1. Errors are filled in. Cost: milliseconds.
FitResult ceres_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                         int log2_p = 8);

}  // namespace talisman::warp
