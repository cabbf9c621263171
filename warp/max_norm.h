// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp of one family has the smallest largest error?
///
///   minimise  maxᵢ ‖W(p̂ᵢ) - pᵢ‖        over the family, in pixels after the divide
///
/// For every family but perspective the residual is linear in the unknowns, so this is a convex problem with
/// a certificate: for any weights w on the simplex √(min_W Σ wᵢ ‖rᵢ‖²) ≤ optimum ≤ maxᵢ ‖rᵢ‖ [A §5]. On
/// positive denominators the perspective problem is quasiconvex [A §5].
///
/// These are the solvers behind `fit()` for the curves whose name ends in i. They solve for the family they
/// are given and for no other: the choice of a simpler family is the dispatcher's.
///
/// Given (programmer error otherwise): sizes agree, all coordinates finite and below kLargestCoordinatePx, at
/// least points_needed(family) points. The dispatcher also has checked that the points span the family
/// (conditioning.h), but a solver that meets points that do not must answer with Degenerate and finite
/// numbers, never with a crash. Returned: warp.family is the family asked for; rms_px, max_px and worst_point
/// are those of the warp as measured; max_lower_bound_px ≤ optimum ≤ max_px. Status:
///   Converged      max_px - lower ≤ relative_gap · max_px, or max_px is at rounding level, or decide_px was
///   decided NotConverged   iterations ran out; usable, and both bounds are true Degenerate     the best map
///   is not acceptable() (conditioning.h): it mirrors, collapses, or has its horizon between the points
/// Both solvers are deterministic and allocate nothing that outlives the call.

#include <span>

#include "warp/fit.h"

namespace talisman::warp {

FitResult fit_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                       const FitOptions& options);

/// The curve `peri` [LS97 4.2]: the smallest largest *homogeneous* residual ‖(u - x w, v - y w)‖ of (u, v, w)
/// = H p̂ against p = (x, y), both sides normalised after Hartley (homography.h), H scaled so that its
/// denominator is 1 at the centroid of p̂. The weights of this metric differ from point to point, so it is no
/// bound in pixels: max_lower_bound_px is 0, and Converged refers to its own gap.
FitResult fit_max_norm_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options);

/// Certified bounds of that optimum: of maxᵢ denᵢ ‖W(p̂ᵢ) - pᵢ‖, px times the denominator.
struct HomogeneousBounds {
  double lower = 0, upper = 0;
};
FitResult fit_max_norm_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options, HomogeneousBounds* bounds);

}  // namespace talisman::warp
