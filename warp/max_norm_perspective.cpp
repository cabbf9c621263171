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
// The remainder is subtracted twice over, the second time for the rounding of L and e.
class PostDivideCertificate {
 public:
  PostDivideCertificate(const PostDivideModel& model, double upper) : model_(model), upper_(upper) {}

  double lower_bound() {
    const Stock stock = take_stock(model_.columns);
    if (!(stock.sum_norms > 0)) return 0;
    const double tau = stock.sum_squares / stock.sum_norms;
    Mat<3> v{};
    Vec<3> e1{}, e2{}, e3{};
    for (int i = 0; i < model_.columns.n; ++i) add_point(i, tau, v, e1, e2, e3);
    Cholesky<3> root;
    if (!root.factor(v, kTinyPivot)) return 0;
    const double reach = model_.columns.now_extent() + upper_;
    const double rest = reach * (length(root, e1) + length(root, e2)) + length(root, e3);
    return std::max(0.0, tau * (1 - 1e-14) - 2 * rest - model_.columns.column_rounding_px());
  }

 private:
  void add_point(int i, double tau, Mat<3>& v, Vec<3>& e1, Vec<3>& e2, Vec<3>& e3) const {
    const ResidualColumns& c = model_.columns;
    const Vec<3> q{1, c.qx[i], c.qy[i]};
    const double share = c.w[i] * model_.factor(i);
    const dvec2 u{share * c.rx[i], share * c.ry[i]};
    const double norm = share * std::sqrt(c.f[i]);
    add_outer<3>(v, norm * norm, q);
    add_scaled<3>(e1, u.x, q);
    add_scaled<3>(e2, u.y, q);
    add_scaled<3>(e3, u.x * c.dx[i] + u.y * c.dy[i] - tau * norm, q);
  }
  static double length(const Cholesky<3>& root, Vec<3> e) {
    root.forward(e);
    return std::sqrt(dot<3>(e, e));
  }

  const PostDivideModel& model_;
  const double upper_;
};

}  // namespace

}  // namespace talisman::warp
