// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp of one family has the smallest largest error?
///
///   minimise  maxᵢ ‖W(p̂ᵢ) - pᵢ‖        over the family, in pixels after the divide
///
/// Translation is the smallest enclosing disc of the displacements, exact (enclosing_disc.h). For isotropic,
/// x/y scale and affine the residual is linear in the unknowns and the problem convex: Lawson steps, then an
/// interior-point method, with a dual certificate (min_max.h, interior_point.h). Perspective is quasiconvex
/// where all denominators are positive [A §5]: the same method from the affine answer, with a certificate of
/// its own (max_norm_perspective.cpp).
///
/// These are the solvers behind `fit()` for the curves whose name ends in i. They solve for the family they
/// are given: the choice of a simpler family is the dispatcher's.
///
/// Sizes must agree (programmer error otherwise); everything else is answered with a status.
///
///   Converged     decide_px was decided, or max_px - lower ≤ max(relative_gap · max_px, rounding)
///   NotConverged  the gap was not closed: iterations, or the best map has a point on its horizon
///   Degenerate    the best map is not acceptable() (conditioning.h): it mirrors, collapses, or has its
///                 horizon between the points; or the points do not span the family (best translation)
///   TooFewPoints  fewer than points_needed(family) (best translation)
///   NotFinite     the identity, errors kHugePx, worst_point the first bad point
///
/// "Rounding" is what an error that is evaluated from the warp's coefficients can be off by: some 1e-14 of
/// the coordinates, more where points are nearly collinear. So a fit without error is Converged with lower =
/// 0.
///
/// rms_px, max_px and worst_point are those of the warp as measured; max_lower_bound_px ≤ optimum ≤ max_px,
/// the optimum being that of warp.family over the maps with positive denominators. The lower bound allows for
/// rounding and holds whatever the status is. warp.family is the family asked for, or Translation in the
/// cases named above.
///
/// Deterministic; up to 64 points nothing is allocated, except for translation. Cost at 14 points of the
/// workload on one 2020s core (tests/bench/max_norm_bench.cpp): affine 0.7 µs decided at 4 px, 7 µs in value
/// (p99 11 µs); perspective 0.8 µs decided, 16 µs in value (p99 27 µs).

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
