// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The point pairs as the maximum-norm solvers see them: centred, the points then also whitened, one column
/// per quantity.
///
///   q = T (p̂ - ĉ)       mean 0; for affine and perspective Σ q qᵀ = n I, otherwise scaled only (see Whitening)
///   d = (p - c) / unit  mean 0; the unit is 1 px, or a power of two px where squares of squares of d could
///                       overflow or vanish
///   rᵢ = dᵢ - W̃(qᵢ)     the residual of the current iterate, units;  fᵢ = ‖rᵢ‖²
///   uᵢ                  scratch for the multipliers of a certificate
///   wᵢ                  the weight (dual variable) of the point, Σ wᵢ = 1
///
/// Whitening costs one pass and buys two things: the least-squares systems are well conditioned whatever the
/// shape of the sprite, and rounding errors are relative to the sprite, not to its place on the display [A
/// §5].

#include <array>
#include <span>
#include <vector>

#include "warp/warp.h"

namespace talisman::warp {

enum class Whitening {
  Uniform,  ///< one scale, so that mean ‖q‖² = 1
  PerAxis,  ///< one scale per axis, so that mean x² = mean y² = 1
  Full,     ///< also decorrelated: mean x y = 0
};

class ResidualColumns {
 public:
  ResidualColumns(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Whitening whitening);
  ResidualColumns(const ResidualColumns&) = delete;
  ResidualColumns& operator=(const ResidualColumns&) = delete;

  /// False: the points then do not span the plane (Full), both axes (PerAxis) or anything (Uniform) beyond
  /// rounding.
  bool spans() const { return spans_; }
  /// The warp in pixels of a map d = linear q + offset.
  Affine2 in_pixels(const Affine2& map) const;
  /// T and -T ĉ: q = whitening()(p̂).
  Affine2 whitening() const;
  dvec2 then_centre() const { return then_centre_; }
  dvec2 now_centre() const { return now_centre_; }
  double unit_px() const { return unit_px_; }
  /// Largest |coordinate| of d, units.
  double now_extent() const { return now_extent_; }
  /// Rounding that the columns d, q and r carry, units: what a lower bound computed from them must give away.
  double column_rounding() const { return column_rounding_; }
  /// Rounding of a residual evaluated from the warp's coefficients in pixels, units; larger far from the
  /// origin.
  double pixel_rounding() const { return pixel_rounding_; }

  const int n;
  double *qx, *qy, *dx, *dy, *rx, *ry, *f, *w, *ux, *uy;

 private:
  static constexpr int kColumns = 10, kInline = 64;
  void place_columns();
  void choose_unit();
  void whiten(Whitening whitening);
  void orthogonalise();

  dvec2 then_centre_{0, 0}, now_centre_{0, 0};
  double t00_ = 1, t01_ = 0, t10_ = 0, t11_ = 1;
  double unit_px_ = 1, now_extent_ = 0, column_rounding_ = 0, pixel_rounding_ = 0;
  bool spans_ = false;
  double inline_[kColumns * kInline];  // left uninitialised on purpose: the constructor writes what is used
  std::vector<double> heap_;           // only for more than kInline points
};

}  // namespace talisman::warp
