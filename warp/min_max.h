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
/// that an interior-point method (interior_point.h) takes over from their weights. An active-set Newton
/// method was tried first and given up: φ is far from its quadratic model wherever the support is still
/// wrong, and most runs ended in the line search.

#include <algorithm>
#include <cmath>
#include <limits>

#include "warp/fit.h"
#include "warp/interior_point.h"
#include "warp/residual_columns.h"
#include "warp/small_dense.h"

namespace talisman::warp {

/// What is known of the optimum, in units of the columns.
struct Bounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::max();
};

/// When is a solver done? See FitOptions; below `floor` rounding decides. In units of the columns.
struct Goal {
  double relative_gap, decide, floor;

  Goal(const FitOptions& options, const ResidualColumns& columns)
      : relative_gap(options.relative_gap),
        decide(options.decide_px / columns.unit_px()),
        floor(columns.pixel_rounding()) {}
  bool certified(const Bounds& b) const {
    return b.upper - b.lower <= std::max(relative_gap * b.upper, floor);
  }
  bool decided(const Bounds& b) const {
    return decide >= 0 && (b.lower > decide || b.upper + floor <= decide);
  }
  bool reached(const Bounds& b) const { return certified(b) || decided(b); }
};

/// Sums over the points at the present weights and residuals.
struct Stock {
  double largest = 0;      ///< max f
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

/// What a run has found so far.
template <class Model>
struct Progress {
  Bounds bounds;
  typename Model::Unknowns best{};
  bool found = false;  ///< `best` holds an iterate
  int iterations = 0;

  void keep_if_better(const Model& model, double upper) {
    if (!(upper < bounds.upper)) return;
    bounds.upper = upper;
    best = model.x;
    found = true;
  }
  void raise(double lower) { bounds.lower = std::max(bounds.lower, lower); }
};

/// Interior-point steps from the best iterate until the goal or the limit. `certify` improves the bounds of
/// the progress from the weights in the columns, and leaves the iterate as it was.
template <class Model, class Certify>
void refine(Model& model, Progress<Model>& progress, const Goal& goal, int limit, const Certify& certify) {
  model.x = progress.best;
  model.update();
  InteriorPoint<Model> interior(model);
  interior.start();
  while (progress.iterations < limit && interior.step()) {
    ++progress.iterations;
    progress.keep_if_better(model, interior.largest_residual());
    // In value mode the certificate is asked for only when it can succeed: it costs up to half a step.
    const bool hopeless = goal.decide < 0 && progress.bounds.upper > goal.floor &&
                          interior.relative_complementarity() > 2 * goal.relative_gap;
    if (hopeless) continue;
    interior.weights_to_columns();
    certify();
    if (goal.reached(progress.bounds)) return;
  }
  // Not reached: at least say how far it is.
  interior.weights_to_columns();
  certify();
}

/// One run for one linear model. Leaves the best iterate in `model.x`.
template <class Model>
class MinMax {
 public:
  // Measured on boxes of 8 … 64 points: two Lawson steps decide most thresholds, and more cost the value mode
  // what they save. No run of 20,000 boxes needed a third of kMostSteps.
  static constexpr int kLawsonSteps = 2, kMostSteps = 60;

  MinMax(Model& model, const Goal& goal) : model_(model), columns_(model.columns), goal_(goal) {}

  /// True if the goal was reached within `max_iterations` (Lawson and interior-point steps together).
  bool run(int max_iterations) {
    const int limit = std::min(max_iterations, kMostSteps);
    if (!run_lawson(limit) && progress_.found && progress_.iterations < limit) {
      refine(model_, progress_, goal_, limit, [this] { certify_beside_iterate(); });
      model_.x = progress_.best;
    }
    return progress_.found && goal_.reached(progress_.bounds);
  }
  /// The first steps only: cheap, and a start for something better. True if the goal was reached.
  bool run_lawson(int max_iterations) {
    const int limit = std::min(max_iterations, 1 + kLawsonSteps);
    while (progress_.iterations < limit) {
      if (progress_.iterations > 0) reweight();
      ++progress_.iterations;
      if (!certify() || goal_.reached(progress_.bounds)) break;
    }
    model_.x = progress_.best;
    return progress_.found && goal_.reached(progress_.bounds);
  }
  const Progress<Model>& progress() const { return progress_; }

 private:
  /// Bounds of the present weights; false if they leave the least-squares problem singular. Moves the
  /// iterate.
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
      progress_.raise(exact - columns_.column_rounding());
    }
    progress_.keep_if_better(model_, upper);
    return true;
  }
  void certify_beside_iterate() {
    const auto iterate = model_.x;
    certify();
    model_.x = iterate;
    model_.update();
  }
  void reweight() {
    const ResidualColumns& c = columns_;
    double sum = 0;
    for (int i = 0; i < c.n; ++i) sum += c.w[i] *= std::sqrt(c.f[i]);
    for (int i = 0; i < c.n; ++i) c.w[i] /= sum;
  }

  Model& model_;
  ResidualColumns& columns_;
  Goal goal_;
  Progress<Model> progress_;
};

}  // namespace talisman::warp
