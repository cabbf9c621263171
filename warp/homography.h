// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which perspective warp has the least sum of squares, before the divide (`per`) and after it (`per2`)?
///
/// With q = (u, v, 1) for a point then and p = (x, y) now, both normalised, and w = 1 + g u + h v:
///
///   per    minimise Σ ‖A q - p w‖²      a linear system of 8 unknowns [LS97 4.2]: the residual is scaled by w
///   per2   minimise Σ ‖A q / w - p‖²    the error on the display
///
/// Normalisation (Hartley, on both sides): the points now are centred and scaled to a root mean square
/// distance of √2; those then are centred, turned to their principal axes and scaled along each, which
/// changes neither minimum because A, g, h absorb it. Fixing w = 1 at the centroid excludes only homographies
/// whose horizon goes through the centroid, which are not acceptable().
///
/// Both are solved in g and h alone. For given g, h the six entries of A follow from a linear fit, so they
/// are projected out (variable projection, Golub & Pereyra 1973, with Kaufman's Jacobian 1975): `per` is one
/// linear solve of 2 unknowns, `per2` a Levenberg-Marquardt iteration over 2 unknowns, started from A alone
/// or from the solution of `per`, whichever is better.

#include <span>

#include "warp/conditioning.h"
#include "warp/fit.h"

namespace talisman::warp {

/// The normalised coordinates of both sides, shared by all perspective fits.
struct PerspectiveFrame {
  Spread then;  ///< spread_of(then_px)
  dvec2 now_centroid{0, 0};
  double now_scale = 1;  ///< px per unit; 1 when all points coincide

  dvec2 normalised_then(dvec2 p) const;
  dvec2 normalised_now(dvec2 p) const { return (p - now_centroid) / now_scale; }
  /// The warp in pixels from a homography between normalised coordinates. With h[2][2] = 1 its denominator is
  /// 1 at the centroid then.
  Warp to_pixels(const dmat3& normalised_now_from_then) const;
};
PerspectiveFrame perspective_frame(std::span<const dvec2> now_px, const Spread& then);

/// Both need ≥ 4 points and strength(Perspective, then) > 0. Status Converged or, when the points do not
/// determine g and h or the best map has its horizon among them, Degenerate (the warp then is not to be
/// used); fit_post_divide also NotConverged. Errors are not filled in. Cost at 14 points: 0.7 µs and
/// 1.7 µs.
FitResult fit_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Spread& then);
FitResult fit_post_divide(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Spread& then,
                          const FitOptions& options);

}  // namespace talisman::warp
