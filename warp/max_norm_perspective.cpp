// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "warp/linear_families.h"
#include "warp/max_norm.h"
#include "warp/max_norm_parts.h"
#include "warp/min_max.h"
#include "warp/projective_families.h"

namespace talisman::warp {
namespace {

// The certificate of the post-divide problem. For any vectors uᵢ and every map with positive denominators and
// maxᵢ ‖rᵢ‖ = t ≤ upper, with aᵢ = dᵢ denᵢ - numᵢ = denᵢ rᵢ:
//
//   Σ uᵢ·aᵢ ≤ t Σ ‖uᵢ‖ denᵢ = t D      and      Σ uᵢ·aᵢ = τ D + (e₃·h₃ - e₁·h₁ - e₂·h₂)
//
//   e₁ = Σ u_x q,  e₂ = Σ u_y q,  e₃ = Σ (u·d - τ ‖u‖) q,  q = (1, q_x, q_y),  h₁ h₂ h₃ the rows of the map.
//
// At the optimum, with uᵢ = λᵢ rᵢ / denᵢ and τ = Σ λ ‖r‖² / Σ λ ‖r‖, all e vanish and τ is the optimum. Near
// it the remainder is bounded by the terms themselves: with V = Σ ‖u‖² q qᵀ = L Lᵀ, h₃ᵀV h₃ = Σ (‖u‖ den)² ≤
// D² because no term is negative, and likewise h₁ᵀV h₁ ≤ (max |d_x| + upper)² D². Hence
//
//   t ≥ τ - ‖L⁻¹e₁‖ (max |d_x| + upper) - ‖L⁻¹e₂‖ (max |d_y| + upper) - ‖L⁻¹e₃‖.
//
// The remainder is subtracted twice over, the second time for the rounding of L and e. The multipliers of an
// interior-point iterate leave a first-order remainder. To first order a change du changes (e₁, e₂, -e₃/E) by
// Σ den Jᵀdu, so that du = -(λ/den) J z with (Σ λ JᵀJ) z = e removes it and leaves its square.
class PostDivideCertificate {
 public:
  explicit PostDivideCertificate(const PostDivideModel& model) : model_(model), c_(model.columns) {
    for (int i = 0; i < c_.n; ++i) {
      const double share = c_.w[i] * model_.factor(i);
      c_.ux[i] = share * c_.rx[i];
      c_.uy[i] = share * c_.ry[i];
    }
  }

  /// The best bound within `refinements` corrections of the multipliers; stops early at `wanted`.
  double lower_bound(double upper, double wanted, int refinements) {
    double best = std::max(0.0, bound(upper));
    for (int k = 0; k < refinements && best < wanted; ++k) {
      if (!(k == 0 ? factor_curvature() : true)) break;
      correct_multipliers();
      best = std::max(best, bound(upper));
    }
    return best;
  }

 private:
  double bound(double upper) {
    double reach = 0, scale = 0;
    for (int i = 0; i < c_.n; ++i) {
      const double den = 1 / model_.factor(i);
      reach += den * (c_.ux[i] * c_.rx[i] + c_.uy[i] * c_.ry[i]);
      scale += den * norm(i);
    }
    if (!(scale > 0)) return 0;
    tau_ = reach / scale;
    Mat<3> v{};
    e1_ = e2_ = e3_ = {};
    for (int i = 0; i < c_.n; ++i) {
      const Vec<3> q{1, c_.qx[i], c_.qy[i]};
      const double size = norm(i);
      add_outer<3>(v, size * size, q);
      add_scaled<3>(e1_, c_.ux[i], q);
      add_scaled<3>(e2_, c_.uy[i], q);
      add_scaled<3>(e3_, c_.ux[i] * c_.dx[i] + c_.uy[i] * c_.dy[i] - tau_ * size, q);
    }
    Cholesky<3> root;
    if (!root.factor(v, kTinyPivot)) return 0;
    const double extent = c_.now_extent() + upper;
    const double rest = extent * (length(root, e1_) + length(root, e2_)) + length(root, e3_);
    return tau_ * (1 - 1e-14) - 2 * rest - c_.column_rounding();
  }
  bool factor_curvature() {
    Mat<8> h{};
    for (int i = 0; i < c_.n; ++i) model_.add_curvature(i, c_.w[i], h);
    return curvature_.factor(h, kTinyPivot);
  }
  void correct_multipliers() {
    const double s = -model_.per_extent;
    Vec<8> z{e1_[0], e1_[1], e1_[2], e2_[0], e2_[1], e2_[2], s * e3_[1], s * e3_[2]};
    curvature_.solve(z);
    for (int i = 0; i < c_.n; ++i) {
      const dvec2 change = c_.w[i] * model_.factor(i) * model_.along(i, z);
      c_.ux[i] -= change.x;
      c_.uy[i] -= change.y;
    }
  }
  double norm(int i) const { return std::sqrt(c_.ux[i] * c_.ux[i] + c_.uy[i] * c_.uy[i]); }
  static double length(const Cholesky<3>& root, Vec<3> e) {
    root.forward(e);
    return std::sqrt(dot<3>(e, e));
  }

  const PostDivideModel& model_;
  const ResidualColumns& c_;
  Cholesky<8> curvature_;
  Vec<3> e1_{}, e2_{}, e3_{};
  double tau_ = 0;
};

/// The post-divide problem from the affine answer of a few Lawson steps.
class PostDivideRun {
 public:
  PostDivideRun(ResidualColumns& columns, const FitOptions& options)
      : model_(columns), goal_(options, columns), limit_(std::min(options.max_iterations, kMostSteps)) {}

  bool run() {
    if (!start_affine()) return false;
    if (!reached() && progress_.iterations < limit_)
      refine(model_, progress_, goal_, limit_, [this] { certify(); });
    model_.x = progress_.best;
    return reached();
  }
  const PostDivideModel& model() const { return model_; }
  const Progress<PostDivideModel>& progress() const { return progress_; }

 private:
  static constexpr int kMostSteps = 200;
  // More corrections gain nothing: the remainder is then rounding.
  static constexpr int kCorrections = 2;

  bool reached() const { return progress_.found && goal_.reached(progress_.bounds); }
  /// Every affine map is a perspective one, so that its error is an upper bound; its lower bound is not ours.
  bool start_affine() {
    AffineModel affine(model_.columns);
    MinMax<AffineModel> lawson(affine, goal_);
    lawson.run_lawson(limit_);
    progress_.iterations = lawson.progress().iterations;
    if (!lawson.progress().found) return false;
    std::copy(affine.x.begin(), affine.x.end(), model_.x.begin());
    progress_.keep_if_better(model_, lawson.progress().bounds.upper);
    return true;
  }
  void certify() {
    const double upper = progress_.bounds.upper;
    const double wanted = goal_.decide >= 0 && goal_.decide < upper ? goal_.decide : upper;
    progress_.raise(PostDivideCertificate(model_).lower_bound(
        upper, wanted - std::max(goal_.relative_gap * upper, goal_.floor), kCorrections));
  }

  PostDivideModel model_;
  Goal goal_;
  Progress<PostDivideModel> progress_;
  int limit_;
};

}  // namespace

FitResult fit_post_divide_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options) {
  ResidualColumns columns(then_px, now_px, Whitening::Full);
  if (!columns.spans()) return fit_nothing(then_px, now_px, Family::Perspective);
  PostDivideRun run(columns, options);
  const bool reached = run.run();
  if (!run.progress().found) return fit_nothing(then_px, now_px, Family::Perspective);
  FitResult result = measured(then_px, now_px, {Family::Perspective, run.model().in_pixels()}, reached);
  result.max_lower_bound_px = std::fmin(run.progress().bounds.lower * columns.unit_px(), result.max_px);
  result.iterations = run.progress().iterations;
  return result;
}

FitResult fit_max_norm_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options) {
  return fit_max_norm_homogeneous(then_px, now_px, options, nullptr);
}

FitResult fit_max_norm_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options, HomogeneousBounds* bounds) {
  if (auto refused = refuse(then_px, now_px, Family::Perspective)) return *refused;
  ResidualColumns columns(then_px, now_px, Whitening::Full);
  if (!columns.spans()) return fit_nothing(then_px, now_px, Family::Perspective);
  HomogeneousModel model(columns);
  MinMax<HomogeneousModel> run(model, Goal({options.relative_gap, options.max_iterations}, columns));
  const bool reached = run.run(options.max_iterations);
  if (!run.progress().found) return fit_nothing(then_px, now_px, Family::Perspective);
  FitResult result = measured(then_px, now_px, {Family::Perspective, model.in_pixels()}, reached);
  result.iterations = run.progress().iterations;
  const Bounds& found = run.progress().bounds;
  if (bounds) *bounds = {found.lower * columns.unit_px(), found.upper * columns.unit_px()};
  return result;
}

}  // namespace talisman::warp
