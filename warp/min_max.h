// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Smallest largest residual of a linear family, with a certificate.
///
///   primal    minimise over x    maxᵢ ‖rᵢ(x)‖                  r linear in x
///   dual      maximise over w    φ(w) = min_x Σ wᵢ ‖rᵢ(x)‖²    w on the simplex;  √φ(w*) = the optimum
///
/// The certificate. At any w, with x its least-squares solution and u = w r, every other x' satisfies
/// Σ u·r' = Σ u·r because Σ Jᵀu = 0, and Σ u·r' ≤ Σ ‖u‖ · max ‖r'‖. Hence
///
///   lower(w) = Σ w ‖r‖² / Σ w ‖r‖  ≤  optimum  ≤  maxᵢ ‖rᵢ‖ = upper(w)
///
/// By Cauchy-Schwarz this is never below the √(Σ w ‖r‖²) of [A §5], and costs no more. In floating point
/// Σ Jᵀu = δ is not zero. Every x' that is not worse than x has Σ w ‖J(x'-x)‖² ≤ (2 upper)², so that
/// |δ·(x'-x)| ≤ 2 upper ‖L⁻¹δ‖ with L Lᵀ = Σ w JᵀJ. This is subtracted twice over, the second time for the
/// rounding of L and δ themselves, and with it the rounding that the columns carry: the bound holds in exact
/// arithmetic.
///
/// The way. A few multiplicative steps w ← w ‖r‖ (Lawson with exponent 1; the "iteratively applied least
/// squares" of [LS97 4.2] after [Gill81]) decide most thresholds at once; they converge linearly at best, so
/// that an interior-point method (interior_point.h) takes over from their weights. An active-set Newton method
/// was tried first and given up: φ is far from its quadratic model wherever the support is still wrong, and
/// most runs ended in the line search.

#include <algorithm>
#include <cmath>
#include <limits>

#include "warp/fit.h"
#include "warp/interior_point.h"
#include "warp/residual_columns.h"
#include "warp/small_dense.h"

namespace talisman::warp {

/// What is known of the optimum, px.
struct Bounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::max();
};

/// When is a solver done? See FitOptions; below `floor_px` rounding decides.
struct Goal {
  double relative_gap, decide_px, floor_px;
  bool certified(const Bounds& b) const {
    return b.upper - b.lower <= std::max(relative_gap * b.upper, floor_px);
  }
  bool decided(const Bounds& b) const {
    return decide_px >= 0 && (b.lower > decide_px || b.upper + floor_px <= decide_px);
  }
  bool reached(const Bounds& b) const { return certified(b) || decided(b); }
};

inline Goal goal_of(const FitOptions& options, const ResidualColumns& columns) {
  return {options.relative_gap, options.decide_px, columns.pixel_rounding_px()};
}

/// Sums over the points at the present weights and residuals.
struct Stock {
  double largest = 0;    ///< max f
  double sum_squares = 0;  ///< Σ w f
  double sum_norms = 0;    ///< Σ w √f
};
inline Stock take_stock(const ResidualColumns& c) {
  Stock s;
  for (int i = 0; i < c.n; ++i) {
    s.largest = std::max(s.largest, c.f[i]);
    s.sum_squares += c.w[i] * c.f[i];
    s.sum_norms += c.w[i] * std::sqrt(c.f[i]);
  }
  return s;
}

/// One run for one linear model. Leaves the best iterate in `model.x`.
template <class Model>
class MinMax {
 public:
  // Measured on boxes of 8 … 64 points: two steps decide most thresholds, and more cost the value mode what
  // they save.
  static constexpr int kLawsonSteps = 2, kMostSteps = 60;

  MinMax(Model& model, const Goal& goal) : model_(model), columns_(model.columns), goal_(goal) {}

  /// True if the goal was reached within `max_iterations` (Lawson and interior-point steps together).
  bool run(int max_iterations) {
    const int limit = std::min(max_iterations, kMostSteps);
    while (iterations_ < std::min(limit, 1 + kLawsonSteps)) {
      if (iterations_ > 0) reweight();
      ++iterations_;
      if (!certify()) break;
      if (goal_.reached(bounds_)) break;
    }
    if (!goal_.reached(bounds_) && iterations_ < limit && found_) refine(limit);
    model_.x = best_;
    return found_ && goal_.reached(bounds_);
  }
  const Bounds& bounds() const { return bounds_; }
  int iterations() const { return iterations_; }

 private:
  /// Bounds of the present weights; false if they leave the least-squares problem singular.
  bool certify() {
    if (!model_.solve()) return false;
    model_.update();
    const Stock stock = take_stock(columns_);
    const double upper = std::sqrt(stock.largest);
    typename Model::Unknowns drift{};
    for (int i = 0; i < columns_.n; ++i)
      add_scaled<Model::kUnknowns>(drift, columns_.w[i], model_.gradient(i));
    model_.forward(drift);
    const double slack = 4 * upper * std::sqrt(dot<Model::kUnknowns>(drift, drift));
    if (stock.sum_norms > 0) {
      const double exact = (stock.sum_squares - slack) / stock.sum_norms * (1 - 1e-14);
      bounds_.lower = std::max(bounds_.lower, exact - columns_.column_rounding_px());
    }
    keep_if_better(upper);
    return true;
  }
  void keep_if_better(double upper) {
    if (!(upper < bounds_.upper)) return;
    bounds_.upper = upper;
    best_ = model_.x;
    found_ = true;
  }
  void reweight() {
    const ResidualColumns& c = columns_;
    double sum = 0;
    for (int i = 0; i < c.n; ++i) sum += c.w[i] *= std::sqrt(c.f[i]);
    for (int i = 0; i < c.n; ++i) c.w[i] /= sum;
  }
  void refine(int limit) {
    model_.x = best_;
    model_.update();
    InteriorPoint<Model> interior(model_);
    interior.start();
    while (iterations_ < limit && interior.step()) {
      ++iterations_;
      keep_if_better(interior.largest_residual());
      // A certificate costs a fifth of a step: in value mode it is asked for only when it can succeed.
      if (goal_.decide_px < 0 && interior.relative_complementarity() > 2 * goal_.relative_gap &&
          bounds_.upper > goal_.floor_px)
        continue;
      const auto iterate = model_.x;

      interior.weights_to_columns();
      certify();
      if (goal_.reached(bounds_)) return;
      model_.x = iterate;
      model_.update();
    }
  }

  Model& model_;
  ResidualColumns& columns_;
  Goal goal_;
  Bounds bounds_;
  typename Model::Unknowns best_{};
  bool found_ = false;
  int iterations_ = 0;
};

}  // namespace talisman::warp
