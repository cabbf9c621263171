// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The two perspective problems, as the solvers see them. In the columns' coordinates (q whitened and
/// centred, d centred, E = the extent of d)
///
///   num = (x₀ + x₁ q_x + x₂ q_y,  x₃ + x₄ q_x + x₅ q_y)      den = 1 + (x₆ q_x + x₇ q_y) / E
///
/// so that den is 1 at the centroid of the points then, which loses nothing: a positive denominator at every
/// point is positive at the centroid. All rows of J = -∂r/∂x have one shape:
///
///   J = m (1, q_x, q_y | 1, q_x, q_y | -v q_x / E, -v q_y / E)
///
///   homogeneous    r = d den - num      m = 1        v = d            linear in x, ‖r‖ = den · error in pixels
///   post-divide    r = d - num / den    m = 1/den    v = num / den    quasiconvex where all den > 0

#include "warp/residual_columns.h"
#include "warp/small_dense.h"

namespace talisman::warp {

template <class Problem>
struct ProjectiveModel {
  static constexpr int kUnknowns = 8;
  using Unknowns = Vec<kUnknowns>;

  ResidualColumns& columns;
  Unknowns x{};
  double per_extent;

  explicit ProjectiveModel(ResidualColumns& residual_columns)
      : columns(residual_columns), per_extent(columns.now_extent() > 0 ? 1 / columns.now_extent() : 1) {}

  dvec2 numerator(int i, const Unknowns& s) const {
    const double qx = columns.qx[i], qy = columns.qy[i];
    return {s[0] + s[1] * qx + s[2] * qy, s[3] + s[4] * qx + s[5] * qy};
  }
  /// Without the constant 1.
  double denominator_part(int i, const Unknowns& s) const {
    return (s[6] * columns.qx[i] + s[7] * columns.qy[i]) * per_extent;
  }
  Unknowns transposed(int i, dvec2 u) const {
    const double qx = columns.qx[i], qy = columns.qy[i], m = self().factor(i);
    const dvec2 v = self().pull(i);
    const double ux = m * u.x, uy = m * u.y, across = -(ux * v.x + uy * v.y) * per_extent;
    return {ux, ux * qx, ux * qy, uy, uy * qx, uy * qy, across * qx, across * qy};
  }
  Unknowns gradient(int i) const { return transposed(i, {columns.rx[i], columns.ry[i]}); }
  dvec2 along(int i, const Unknowns& s) const {
    return self().factor(i) * (numerator(i, s) - self().pull(i) * denominator_part(i, s));
  }
  void add_curvature(int i, double w, Mat<kUnknowns>& h) const {
    const double qx = columns.qx[i], qy = columns.qy[i], m = self().factor(i);
    const dvec2 v = self().pull(i) * -per_extent;
    const Unknowns row_x{m, m * qx, m * qy, 0, 0, 0, m * v.x * qx, m * v.x * qy};
    const Unknowns row_y{0, 0, 0, m, m * qx, m * qy, m * v.y * qx, m * v.y * qy};
    add_outer<kUnknowns>(h, w, row_x);
    add_outer<kUnknowns>(h, w, row_y);
  }
  static void complete_curvature(Mat<kUnknowns>&) {}
  /// Target-from-source in pixels, scaled to a last entry of 1 where that is possible.
  dmat3 in_pixels() const {
    const dvec2 c = columns.now_centre();
    const double g = x[6] * per_extent, h = x[7] * per_extent, px = columns.unit_px();
    // Rows of the map from q; the centre of the points now is added before the divide.
    const dvec3 u{px * x[1] + c.x * g, px * x[2] + c.x * h, px * x[0] + c.x};
    const dvec3 v{px * x[4] + c.y * g, px * x[5] + c.y * h, px * x[3] + c.y};
    const dvec3 w{g, h, 1};
    const Affine2 t = columns.whitening();
    const auto row = [&t](const dvec3& r) {
      return dvec3{r.x * t.a + r.y * t.c, r.x * t.b + r.y * t.d, r.x * t.tx + r.y * t.ty + r.z};
    };
    const dvec3 a = row(u), b = row(v), d = row(w);
    dmat3 m{a.x, b.x, d.x, a.y, b.y, d.y, a.z, b.z, d.z};
    return d.z > 1e-9 ? m / d.z : m;
  }

 private:
  const Problem& self() const { return static_cast<const Problem&>(*this); }
};

/// r = d den - num, the curve peri [LS97 4.2].
struct HomogeneousModel : ProjectiveModel<HomogeneousModel> {
  using ProjectiveModel::ProjectiveModel;
  Cholesky<kUnknowns> root;

  double factor(int) const { return 1; }
  dvec2 pull(int i) const { return {columns.dx[i], columns.dy[i]}; }
  bool solve() {
    Mat<kUnknowns> h{};
    Unknowns b{};
    for (int i = 0; i < columns.n; ++i) {
      add_curvature(i, columns.w[i], h);
      add_scaled<kUnknowns>(b, columns.w[i], transposed(i, {columns.dx[i], columns.dy[i]}));
    }
    if (!root.factor(h, 1e-13)) return false;
    root.solve(b);
    x = b;
    return true;
  }
  bool update() {
    const ResidualColumns& c = columns;
    for (int i = 0; i < c.n; ++i) {
      const dvec2 image = along(i, x);
      c.rx[i] = c.dx[i] - image.x;
      c.ry[i] = c.dy[i] - image.y;
      c.f[i] = c.rx[i] * c.rx[i] + c.ry[i] * c.ry[i];
    }
    return true;
  }
  void forward(Unknowns& g) const { root.forward(g); }
  double bend(int, dvec2 s, const Unknowns&) const { return s.x * s.x + s.y * s.y; }
};

/// r = d - num / den, the curve per2i.
struct PostDivideModel : ProjectiveModel<PostDivideModel> {
  using ProjectiveModel::ProjectiveModel;
  // A denominator this small is on the horizon: the iterate is outside the domain.
  static constexpr double kHorizon = 1e-9;

  double inverse_denominator(int i) const { return 1 / (1 + denominator_part(i, x)); }
  double factor(int i) const { return inverse_denominator(i); }
  dvec2 pull(int i) const { return {columns.dx[i] - columns.rx[i], columns.dy[i] - columns.ry[i]}; }
  bool update() {
    const ResidualColumns& c = columns;
    for (int i = 0; i < c.n; ++i) {
      const double den = 1 + denominator_part(i, x);
      if (!(den > kHorizon)) return false;
      const dvec2 image = numerator(i, x) / den;
      c.rx[i] = c.dx[i] - image.x;
      c.ry[i] = c.dy[i] - image.y;
      c.f[i] = c.rx[i] * c.rx[i] + c.ry[i] * c.ry[i];
    }
    return true;
  }
  /// Along a step the image moves by J dx / (1 + δ), δ = dden / den: the second-order part of f.
  double bend(int i, dvec2 s, const Unknowns& step) const {
    const double shrink = denominator_part(i, step) * factor(i);
    return s.x * s.x + s.y * s.y + 2 * shrink * (columns.rx[i] * s.x + columns.ry[i] * s.y);
  }
};

}  // namespace talisman::warp
