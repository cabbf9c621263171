// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The families whose residual is linear in the unknowns, as the solvers of min_max_*.h need them. A model
/// holds the iterate and, for weights w on the simplex, the factored normal matrix H = Σ wᵢ JᵢᵀJᵢ = L Lᵀ with
/// Jᵢ = -∂rᵢ/∂x (2 × kUnknowns).
///
///   solve(w)        x minimises Σ wᵢ ‖rᵢ‖²; false: H is numerically singular
///   update()        writes rx, ry, f of the columns from x
///   gradient(i)     Jᵢᵀ rᵢ = -½ ∇fᵢ
///   forward(g)      g becomes L⁻¹ g
///
/// Affine and x/y scale separate into rows that share or own a small matrix, which is why they are not
/// written as a general 2n × 6 design: 3 × 3 in place of 6 × 6 is four times faster.

#include "warp/residual_columns.h"
#include "warp/small_dense.h"

namespace talisman::warp {

/// Pivots below this share of their diagonal: the weights are all on points that do not span the family.
inline constexpr double kTinyPivot = 1e-13;

/// What all of them share.
template <class Family, int Dimensions>
struct LinearModel {
  static constexpr int kUnknowns = Dimensions;
  using Unknowns = Vec<kUnknowns>;

  ResidualColumns& columns;
  Unknowns x{};

  explicit LinearModel(ResidualColumns& residual_columns) : columns(residual_columns) {}
  bool update() {
    const ResidualColumns& c = columns;
    for (int i = 0; i < c.n; ++i) {
      const dvec2 image = self().along(i, x);
      c.rx[i] = c.dx[i] - image.x;
      c.ry[i] = c.dy[i] - image.y;
      c.f[i] = c.rx[i] * c.rx[i] + c.ry[i] * c.ry[i];
    }
    return true;
  }
  Unknowns gradient(int i) const { return self().transposed(i, {columns.rx[i], columns.ry[i]}); }
  /// Half the second derivative of fᵢ along a step.
  double bend(int, dvec2 along, const Unknowns&) const { return along.x * along.x + along.y * along.y; }

 private:
  const Family& self() const { return static_cast<const Family&>(*this); }
};

/// d = (x, y)ᵀ ↦ one row of an affine map on (1, x, y), both rows with the same 3 × 3 matrix.
struct AffineModel : LinearModel<AffineModel, 6> {
  static constexpr Whitening kWhitening = Whitening::Full;
  static constexpr Family kFamily = Family::Affine;
  using LinearModel::LinearModel;

  Cholesky<3> root;

  bool solve() {
    const ResidualColumns& c = columns;
    Mat<3> h{};
    Vec<3> bx{}, by{};
    for (int i = 0; i < c.n; ++i) {
      const double w = c.w[i], wx = w * c.qx[i], wy = w * c.qy[i];
      h[0][0] += w;
      h[1][0] += wx;
      h[2][0] += wy;
      h[1][1] += wx * c.qx[i];
      h[2][1] += wx * c.qy[i];
      h[2][2] += wy * c.qy[i];
      bx[0] += w * c.dx[i];
      bx[1] += wx * c.dx[i];
      bx[2] += wy * c.dx[i];
      by[0] += w * c.dy[i];
      by[1] += wx * c.dy[i];
      by[2] += wy * c.dy[i];
    }
    if (!root.factor(h, kTinyPivot)) return false;
    root.solve(bx);
    root.solve(by);
    x = {bx[0], bx[1], bx[2], by[0], by[1], by[2]};
    return true;
  }
  Unknowns transposed(int i, dvec2 v) const {
    const double qx = columns.qx[i], qy = columns.qy[i];
    return {v.x, v.x * qx, v.x * qy, v.y, v.y * qx, v.y * qy};
  }
  void forward(Unknowns& g) const {
    Vec<3> gx{g[0], g[1], g[2]}, gy{g[3], g[4], g[5]};
    root.forward(gx);
    root.forward(gy);
    g = {gx[0], gx[1], gx[2], gy[0], gy[1], gy[2]};
  }
  dvec2 along(int i, const Unknowns& s) const {
    const double qx = columns.qx[i], qy = columns.qy[i];
    return {s[0] + s[1] * qx + s[2] * qy, s[3] + s[4] * qx + s[5] * qy};
  }
  void add_curvature(int i, double w, Mat<kUnknowns>& h) const {
    const double qx = columns.qx[i], qy = columns.qy[i], wx = w * qx, wy = w * qy;
    h[0][0] += w;
    h[1][0] += wx;
    h[2][0] += wy;
    h[1][1] += wx * qx;
    h[2][1] += wx * qy;
    h[2][2] += wy * qy;
  }
  static void complete_curvature(Mat<kUnknowns>& h) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b <= a; ++b) h[3 + a][3 + b] = h[a][b];
  }
  Affine2 map() const { return {x[1], x[2], x[0], x[4], x[5], x[3]}; }
};

/// d_x = x₀ + x₁ q_x, d_y = x₂ + x₃ q_y: two rows with a 2 × 2 matrix each.
struct XyScaleModel : LinearModel<XyScaleModel, 4> {
  static constexpr Whitening kWhitening = Whitening::PerAxis;
  static constexpr Family kFamily = Family::XyScale;
  using LinearModel::LinearModel;

  Cholesky<2> root_x, root_y;

  bool solve() {
    const ResidualColumns& c = columns;
    const auto row = [&c](const double* q, const double* d, Cholesky<2>& root, double* out) {
      Mat<2> h{};
      Vec<2> b{};
      for (int i = 0; i < c.n; ++i) {
        const double w = c.w[i], wq = w * q[i];
        h[0][0] += w;
        h[1][0] += wq;
        h[1][1] += wq * q[i];
        b[0] += w * d[i];
        b[1] += wq * d[i];
      }
      if (!root.factor(h, kTinyPivot)) return false;
      root.solve(b);
      out[0] = b[0];
      out[1] = b[1];
      return true;
    };
    return row(c.qx, c.dx, root_x, &x[0]) && row(c.qy, c.dy, root_y, &x[2]);
  }
  Unknowns transposed(int i, dvec2 v) const { return {v.x, v.x * columns.qx[i], v.y, v.y * columns.qy[i]}; }
  void forward(Unknowns& g) const {
    Vec<2> gx{g[0], g[1]}, gy{g[2], g[3]};
    root_x.forward(gx);
    root_y.forward(gy);
    g = {gx[0], gx[1], gy[0], gy[1]};
  }
  dvec2 along(int i, const Unknowns& s) const {
    return {s[0] + s[1] * columns.qx[i], s[2] + s[3] * columns.qy[i]};
  }
  void add_curvature(int i, double w, Mat<kUnknowns>& h) const {
    const double qx = columns.qx[i], qy = columns.qy[i], wx = w * qx, wy = w * qy;
    h[0][0] += w;
    h[1][0] += wx;
    h[1][1] += wx * qx;
    h[3][2] += wy;
    h[3][3] += wy * qy;
  }
  static void complete_curvature(Mat<kUnknowns>& h) { h[2][2] = h[0][0]; }
  Affine2 map() const { return {x[1], 0, x[0], 0, x[3], x[2]}; }
};

/// d = (x₀, x₁) + x₂ q: the scale couples the rows.
struct IsotropicModel : LinearModel<IsotropicModel, 3> {
  static constexpr Whitening kWhitening = Whitening::Uniform;
  static constexpr Family kFamily = Family::Isotropic;
  using LinearModel::LinearModel;

  Cholesky<3> root;

  bool solve() {
    const ResidualColumns& c = columns;
    Mat<3> h{};
    Unknowns b{};
    for (int i = 0; i < c.n; ++i) {
      const double w = c.w[i], wx = w * c.qx[i], wy = w * c.qy[i];
      h[0][0] += w;
      h[2][0] += wx;
      h[2][1] += wy;
      h[2][2] += wx * c.qx[i] + wy * c.qy[i];
      b[0] += w * c.dx[i];
      b[1] += w * c.dy[i];
      b[2] += wx * c.dx[i] + wy * c.dy[i];
    }
    h[1][1] = h[0][0];
    if (!root.factor(h, kTinyPivot)) return false;
    root.solve(b);
    x = b;
    return true;
  }
  Unknowns transposed(int i, dvec2 v) const { return {v.x, v.y, v.x * columns.qx[i] + v.y * columns.qy[i]}; }
  void forward(Unknowns& g) const { root.forward(g); }
  dvec2 along(int i, const Unknowns& s) const {
    return {s[0] + s[2] * columns.qx[i], s[1] + s[2] * columns.qy[i]};
  }
  void add_curvature(int i, double w, Mat<kUnknowns>& h) const {
    const double qx = columns.qx[i], qy = columns.qy[i], wx = w * qx, wy = w * qy;
    h[0][0] += w;
    h[2][0] += wx;
    h[2][1] += wy;
    h[2][2] += wx * qx + wy * qy;
  }
  static void complete_curvature(Mat<kUnknowns>& h) { h[1][1] = h[0][0]; }
  Affine2 map() const { return {x[2], 0, x[0], 0, x[2], x[1]}; }
};

}  // namespace talisman::warp
