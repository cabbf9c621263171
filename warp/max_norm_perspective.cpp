// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "warp/linear_families.h"
#include "warp/max_norm_solvers.h"
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
// At the optimum, with uᵢ = λᵢ rᵢ / denᵢ and τ = Σ λ ‖r‖² / Σ λ ‖r‖, all e vanish and τ is the optimum. Near it
// the remainder is bounded by the terms themselves: with V = Σ ‖u‖² q qᵀ = L Lᵀ, h₃ᵀV h₃ = Σ (‖u‖ den)² ≤ D²
// because no term is negative, and likewise h₁ᵀV h₁ ≤ (max |d_x| + upper)² D². Hence
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
    return tau_ * (1 - 1e-14) - 2 * rest - c_.column_rounding_px();
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

}  // namespace

}  // namespace talisman::warp
