// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp of a linear family has the least sum of squares?
///
///   minimise Σᵢ ‖A q̂ᵢ - pᵢ‖²,  q̂ = (x̂, ŷ, 1)         [LS97 4.1]
///
/// As printed, A = P P̂ᵀ(P̂P̂ᵀ)⁻¹ = P K. The printed K is a misprint: it must be K = P̂ᵀ(P̂P̂ᵀ)⁻¹, which depends on
/// the points of the last render only and is kept until the next one. Here K is computed about the centroid
/// and along the principal axes of p̂, where the matrix to invert is diagonal: the raw normal equations lose
/// 0.3 px in double on a sprite of 2 px at (700, 700) [A §5].
///
///   D = Σᵢ (pᵢ - p₀) kᵢᵀ     (2×2; Σ kᵢ = 0, so any p₀ will do)          t = p̄ - D p̂̄
///
/// The other linear families have the closed forms
///
///   translation    t = p̄ - p̂̄
///   isotropic      s = Σ (p̂ᵢ - p̂̄)·(pᵢ - p̄) / Σ ‖p̂ᵢ - p̂̄‖²
///   x/y scale      the same for each axis
///
/// The isotropic scale has no rotation: it is the paper's scaling with one factor.

#include <span>
#include <vector>

#include "warp/conditioning.h"
#include "warp/fit.h"

namespace talisman::warp {

/// The best warp of a family other than Perspective. `spread` is that of then_px, with strength(family,
/// spread) > 0 (otherwise the answer may be non-finite; the caller checks it with acceptable()). Cost: O(n),
/// about 12 multiply-adds per point.
Warp fit_least_squares(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                       const Spread& spread);

/// The affine curve `aff` with its K kept from one render to the next.
///
///   AffineLeastSquares solver(points_at_last_render);        // once per render
///   FitResult fitted = solver.fit(points_now);               // each frame: 4 multiply-adds per point, 8
///   more to measure it
///
/// The same answer as fit(then, now, Curve::aff) to rounding, with the same chain of simpler families.
class AffineLeastSquares {
 public:
  explicit AffineLeastSquares(std::span<const dvec2> then_px);
  FitResult fit(std::span<const dvec2> now_px) const;
  std::span<const dvec2> then_px() const { return then_px_; }

 private:
  std::vector<dvec2> then_px_;
  std::vector<dvec2> k_;  ///< rows of K; empty where the affine family has no clear answer
  dvec2 centroid_{0, 0};
};

}  // namespace talisman::warp
