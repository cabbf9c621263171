// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp of a family carries the characteristic points then to those now with the least error?
///
///   least squares:  minimise  √(Σᵢ ‖W(p̂ᵢ) - pᵢ‖² / n)        (rms_px)
///   maximum norm:   minimise  maxᵢ ‖W(p̂ᵢ) - pᵢ‖              (max_px), with a certified lower bound
///
/// All fits are in double, on centred and scaled points: the raw normal equations of [LS97 4.1] lose whole
/// pixels on small sprites far from the origin [A §5]. Note that the printed K of the paper is a misprint;
/// K = P̂ᵀ(P̂P̂ᵀ)⁻¹.
///
/// Every outcome is data: a fit never throws, never returns a non-finite number, and never silently mirrors
/// the sprite.

#include <cstdint>
#include <span>
#include <string_view>

#include "warp/warp.h"

namespace talisman::warp {

/// The error, in pixels, of a warp that has none: finite, so that it can be printed, compared and added up.
/// Also the cap of every error that is reported.
inline constexpr double kHugePx = 1e30;

enum class FitStatus : std::uint8_t {
  Converged,     ///< the result is what was asked for
  TooFewPoints,  ///< fewer points than the family needs; a simpler family was used (`warp.family` names it)
  Degenerate,  ///< points coincide, are collinear, or the best map collapses or mirrors the sprite; a simpler
               ///< family was used
  NotFinite,   ///< a point is NaN, infinite or beyond kLargestCoordinatePx; the warp is the identity, the
               ///< errors are kHugePx, worst_point is the first bad point
  NotConverged,  ///< iterations ran out; the warp is usable, its errors are true, the bound is not tight
};
std::string_view name(FitStatus status);

struct FitResult {
  FitStatus status = FitStatus::TooFewPoints;
  Warp warp;
  double rms_px = 0;  ///< over the points, of `warp`
  double max_px = 0;  ///< over the points, of `warp`: an upper bound of the optimum
  double max_lower_bound_px =
      0;  ///< certified: no warp of the family used has a smaller maximum; 0 for fits that do not compute it
  int worst_point = -1;  ///< index of the point with the largest error; -1 without points
  int iterations = 0;
  bool usable() const { return status != FitStatus::NotFinite; }
};

struct FitOptions {
  double relative_gap = 1e-6;  ///< value mode: stop when max_px - lower ≤ gap · max_px; (0, 1)
  int max_iterations = 200;    ///< ≥ 1
  double decide_px = -1;  ///< ≥ 0: decision mode, stop as soon as this threshold lies outside [lower, max_px]
};

/// Fits `curve` to the pairs. Sizes must agree (programmer error otherwise). For fewer points than the family
/// needs, or degenerate ones, the next simpler family that has an answer is used and the status says so; with
/// no points at all the warp is the identity, the status TooFewPoints and every error is 0. The chain is
///
///   perspective → affine → x/y scale → isotropic → translation
///
/// with the norm of the curve in each. The rules that demote a fit are in conditioning.h; `Degenerate` with
/// the family that was asked for means that the points are nearly collinear and the warp is blended with that
/// of the next family. Points that did not move have the identity of the family as their exact answer.
///
/// `pers` needs the layer in space (shade.h): without it there is no quadrilateral, and the affine warp is
/// returned as Degenerate; `pers2` then is refined from the affine warp, which reaches the same optimum
/// unless there are several.
///
/// Cost at 14 points, measured beside a bare centred 2×2 solve of 0.05 µs: trn … aff 0.3 µs (0.1 µs with the
/// K of AffineLeastSquares kept), per 0.8 µs, per2 1.8 µs; the maximum norms see max_norm.h; pers2 (Ceres) 40
/// µs and more.
FitResult fit(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Curve curve,
              const FitOptions& options = {});

/// Fills rms_px, max_px and worst_point of `result` from its warp.
void measure(std::span<const dvec2> then_px, std::span<const dvec2> now_px, FitResult& result);

}  // namespace talisman::warp
