// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Primal-dual interior-point steps for   minimise s   subject to   fᵢ(x) = ‖rᵢ(x)‖² ≤ s.
///
/// With the dual variables λᵢ ≥ 0 and the gaps cᵢ = s - fᵢ > 0, the optimum satisfies
///
///   Σ λᵢ gᵢ = 0,  gᵢ = Jᵢᵀrᵢ        Σ λᵢ = 1        λᵢ cᵢ = 0
///
/// A step is Newton's on this system with λᵢ cᵢ = μ in place of 0, after Mehrotra: a predictor with μ = 0
/// tells how small μ may be chosen, and its second-order terms correct the step. Because f is a quadratic
/// (exactly so in the linear families) the corrector knows them: along a·dx, fᵢ bends by a² bendᵢ = a² ‖Jᵢ
/// dx‖² and Σ λᵢ gᵢ by -Σ dλᵢ JᵢᵀJᵢ dx. That is why some 5 steps suffice where a log-barrier method took 23
/// (performance of the prototypes: [A §5]).
///
/// The normal matrix is H + 2 Σ κᵢ (gᵢ - m)(gᵢ - m)ᵀ with H = Σ λᵢ JᵢᵀJᵢ, κᵢ = λᵢ/cᵢ and m the κ-mean of g: s
/// is eliminated by centring, which subtracts nothing that is nearly equal.
///
/// For the post-divide residual, which is not linear, H is the Gauss-Newton part of the Hessian. The rest,
/// -Σ λᵢ/denᵢ (gᵢ ∇denᵢᵀ + ∇denᵢ gᵢᵀ), vanishes on the directions in which no active fᵢ changes, so that
/// convergence stays superlinear and H stays positive definite.
///
/// The model supplies x, update() (false: x is outside the domain), gradient(i), transposed(i, v) = Jᵢᵀ v,
/// along(i, dx) = Jᵢ dx, bend(i, along, dx), add_curvature(i, λ, H), complete_curvature(H).

#include <algorithm>
#include <cmath>
#include <vector>

#include "warp/residual_columns.h"
#include "warp/small_dense.h"

namespace talisman::warp {

template <class Model>
class InteriorPoint {
 public:
  explicit InteriorPoint(Model& model) : model_(model), columns_(model.columns), n_(model.columns.n) {
    if (n_ > kInline) heap_.resize(n_);
    points_ = n_ > kInline ? heap_.data() : inline_;
  }

  /// From the residuals and weights of the columns.
  void start() {
    for (int i = 0; i < n_; ++i) points_[i].dual = std::max(columns_.w[i], kLeastShare / n_);
    set_level(kStartLevel);
  }

  /// False when there is no step that stays inside, even after going back to the middle some times.
  bool step() {
    if (!(level_ > 0) || !linearise()) return false;
    const double mean = complementarity();
    for (int i = 0; i < n_; ++i) points_[i].target = -points_[i].dual * points_[i].gap;
    Unknowns bent{};
    find_direction(bent);
    const double left = std::max(share_left_by_predictor(mean), least_left_);
    const double centring = left * left * left;
    for (int i = 0; i < n_; ++i) {
      Point& p = points_[i];
      add_scaled<kUnknowns>(bent, p.d_dual, model_.transposed(i, p.along));
      p.target = centring * mean - p.dual * p.gap - p.d_dual * (p.d_gap - p.bend) + p.dual * p.bend;
    }
    find_direction(bent);
    double way = (1 - std::clamp(left, kLeastMargin, kMostMargin)) * way_to_boundary();
    if (way < kShortWay) way = recentred_way(mean);
    const double moved = move(std::min(1.0, way));
    short_steps_ = moved < kShortWay ? short_steps_ + 1 : 0;
    if (moved > 0 && short_steps_ < patience_) return true;
    return restart();
  }

  /// Σ λ c / s: what the present iterate can at best be certified to, relative to s.
  double relative_complementarity() const { return n_ * complementarity() / level_; }
  double largest_residual() const { return std::sqrt(largest()); }
  void weights_to_columns() const {
    double sum = 0;
    for (int i = 0; i < n_; ++i) sum += points_[i].dual;
    for (int i = 0; i < n_; ++i) columns_.w[i] = points_[i].dual / sum;
  }

 private:
  static constexpr int kUnknowns = Model::kUnknowns, kInline = 64, kMostHalvings = 20;
  // The start: s above the largest f by this factor, and no dual below this share of the mean. The number of
  // steps hardly depends on either (1.02 … 1.3, 0.01 … 1).
  static constexpr double kStartLevel = 1.02, kLeastShare = 0.1;
  static constexpr double kShortWay = 0.3, kRecentre = 0.5, kLeastMargin = 1e-3, kMostMargin = 0.02;
  static constexpr double kRestartLevel = 1.5, kCarefulLeft = 0.5;
  static constexpr int kShortSteps = 2, kMostPatience = 32;
  using Unknowns = typename Model::Unknowns;
  struct Point {
    double dual, gap, per_gap, kappa;
    double d_dual, d_gap, bend, target;
    dvec2 along;
    Unknowns g;
  };

  void set_level(double above) {
    level_ = above * largest();
    double sum = 0;
    for (int i = 0; i < n_; ++i) sum += points_[i].dual;
    for (int i = 0; i < n_; ++i) {
      points_[i].dual /= sum;
      points_[i].gap = level_ - columns_.f[i];
    }
  }
  /// Keeps the iterate and goes back to the middle, from there on with smaller reductions of μ:
  /// complementarity that has fallen ahead of stationarity cannot be mended by steps along the boundary.
  bool restart() {
    if (patience_ > kMostPatience) return false;
    for (int i = 0; i < n_; ++i) points_[i].dual = 1.0 / n_;
    set_level(kRestartLevel);
    short_steps_ = 0;
    patience_ *= 2;
    least_left_ = kCarefulLeft;
    return true;
  }

  double largest() const { return *std::max_element(columns_.f, columns_.f + n_); }
  double complementarity() const {
    double sum = 0;
    for (int i = 0; i < n_; ++i) sum += points_[i].dual * points_[i].gap;
    return sum / n_;
  }

  /// Gradients, their κ-mean and the factored normal matrix at the iterate; ∇fᵢ = -2 gᵢ, ∇²fᵢ = 2 JᵢᵀJᵢ.
  bool linearise() {
    Mat<kUnknowns> h{};
    mean_ = {};
    stationarity_ = {};
    sum_kappa_ = sum_dual_ = 0;
    for (int i = 0; i < n_; ++i) {
      Point& p = points_[i];
      p.g = model_.gradient(i);
      p.per_gap = 1 / p.gap;
      p.kappa = p.dual * p.per_gap;
      sum_kappa_ += p.kappa;
      sum_dual_ += p.dual;
      add_scaled<kUnknowns>(mean_, p.kappa, p.g);
      add_scaled<kUnknowns>(stationarity_, p.dual, p.g);
      model_.add_curvature(i, p.dual, h);
    }
    Model::complete_curvature(h);
    for (double& v : mean_) v /= sum_kappa_;
    for (int i = 0; i < n_; ++i) {
      Unknowns centred = points_[i].g;
      add_scaled<kUnknowns>(centred, -1, mean_);
      add_outer<kUnknowns>(h, 2 * points_[i].kappa, centred);
    }
    return root_.factor(h, 1e-15);
  }

  /// dx, ds and from them dλ, dc for the targets λ dc + c dλ = target; `bent` is the second-order term of
  /// stationarity.
  void find_direction(const Unknowns& bent) {
    double sum = sum_dual_ - 1;
    Unknowns b = stationarity_;
    for (int i = 0; i < n_; ++i) {
      const double e = points_[i].target * points_[i].per_gap;
      sum += e;
      add_scaled<kUnknowns>(b, e, points_[i].g);
    }
    add_scaled<kUnknowns>(b, -1, bent);
    add_scaled<kUnknowns>(b, -sum, mean_);
    root_.solve(b);
    dx_ = b;
    d_level_ = sum / sum_kappa_ - 2 * dot<kUnknowns>(mean_, dx_);
    for (int i = 0; i < n_; ++i) {
      Point& p = points_[i];
      p.along = model_.along(i, dx_);
      p.bend = model_.bend(i, p.along, dx_);
      p.d_gap = d_level_ + 2 * (columns_.rx[i] * p.along.x + columns_.ry[i] * p.along.y);
      p.d_dual = p.target * p.per_gap - p.kappa * p.d_gap;
    }
  }

  /// The share of complementarity that the predictor would leave.
  double share_left_by_predictor(double mean) const {
    const double a = std::min(1.0, way_to_boundary());
    double left = 0;
    for (int i = 0; i < n_; ++i) {
      const Point& p = points_[i];
      left += (p.dual + a * p.d_dual) * (p.gap + a * (p.d_gap - a * p.bend));
    }
    return std::clamp(left / n_ / mean, 0.0, 1.0);
  }

  /// A pair λᵢ, cᵢ that is far below the others blocks every step; a plain Newton step towards a common λ c
  /// frees it.
  double recentred_way(double mean) {
    for (int i = 0; i < n_; ++i) points_[i].target = kRecentre * mean - points_[i].dual * points_[i].gap;
    find_direction({});
    return (1 - kMostMargin) * way_to_boundary();
  }

  /// Largest a ≤ 2 with λ + a dλ ≥ 0 and c + a dc - a² bend ≥ 0 for all points.
  double way_to_boundary() const {
    double a = 2;
    for (int i = 0; i < n_; ++i) {
      const Point& p = points_[i];
      if (p.dual + a * p.d_dual < 0) a = -p.dual / p.d_dual;
      if (p.gap + a * (p.d_gap - a * p.bend) < 0) {
        const double root = std::sqrt(p.d_gap * p.d_gap + 4 * p.gap * p.bend);
        a = p.d_gap > 0 ? (p.d_gap + root) / (2 * p.bend) : 2 * p.gap / (root - p.d_gap);
      }
    }
    return a;
  }

  /// The share of the step that stays inside, halved from `a`; 0 if none does, and the iterate is then
  /// unchanged.
  double move(double a) {
    const Unknowns x = model_.x;
    const double level = level_;
    for (int tries = 0; tries < kMostHalvings; ++tries, a *= 0.5) {
      model_.x = x;
      add_scaled<kUnknowns>(model_.x, a, dx_);
      level_ = level + a * d_level_;
      if (!model_.update() || !(level_ > largest())) continue;
      for (int i = 0; i < n_; ++i) {
        points_[i].gap = level_ - columns_.f[i];
        points_[i].dual += a * points_[i].d_dual;
      }
      return a;
    }
    model_.x = x;
    level_ = level;
    model_.update();
    return 0;
  }

  Model& model_;
  ResidualColumns& columns_;
  const int n_;
  double level_ = 0, d_level_ = 0, sum_kappa_ = 0, sum_dual_ = 0;
  Unknowns mean_{}, stationarity_{}, dx_{};
  double least_left_ = 0;
  int short_steps_ = 0, patience_ = kShortSteps;
  Cholesky<kUnknowns> root_;
  Point* points_;
  Point inline_[kInline];
  std::vector<Point> heap_;
};

}  // namespace talisman::warp
