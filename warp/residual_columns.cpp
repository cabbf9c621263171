// SPDX-License-Identifier: Apache-2.0
#include "warp/residual_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talisman::warp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Below this share of the length a width is made of rounding errors; well below kCollinearRatio, so that the
// dispatcher's rule decides first.
constexpr double kNoWidth = 1e-12;
// Between this and its inverse the fourth powers of lengths are far from the limits of a double.
constexpr double kSmallExtent = 1e-30;

dvec2 mean(std::span<const dvec2> points) {
  dvec2 sum{0, 0};
  for (const dvec2& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double largest(const double* a, const double* b, int n) {
  double m = 0;
  for (int i = 0; i < n; ++i) m = std::max(m, std::max(std::abs(a[i]), std::abs(b[i])));
  return m;
}

double sum_of_products(const double* a, const double* b, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

double root_mean_square(const double* a, int n) { return std::sqrt(sum_of_products(a, a, n) / n); }

}  // namespace

ResidualColumns::ResidualColumns(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                 Whitening whitening)
    : n(static_cast<int>(then_px.size())) {
  place_columns();
  then_centre_ = mean(then_px);
  now_centre_ = mean(now_px);
  for (int i = 0; i < n; ++i) {
    qx[i] = then_px[i].x - then_centre_.x;
    qy[i] = then_px[i].y - then_centre_.y;
    dx[i] = now_px[i].x - now_centre_.x;
    dy[i] = now_px[i].y - now_centre_.y;
    w[i] = 1.0 / n;
  }
  now_extent_ = largest(dx, dy, n);
  choose_unit();
  const double then_extent = largest(qx, qy, n);
  const double then_place = std::abs(then_centre_.x) + std::abs(then_centre_.y);
  const double now_place = (std::abs(now_centre_.x) + std::abs(now_centre_.y)) / unit_px_;
  if (then_extent > 4 * kEpsilon * then_place) whiten(whitening);
  const double stretch = std::max(std::abs(t00_) + std::abs(t01_), std::abs(t10_) + std::abs(t11_));
  column_rounding_ = 32 * kEpsilon * now_extent_ * (1 + stretch * then_extent);
  pixel_rounding_ = column_rounding_ + 32 * kEpsilon * (now_place + now_extent_ * stretch * then_place);
}

void ResidualColumns::place_columns() {
  double* base = inline_;
  if (n > kInline) {
    heap_.resize(static_cast<std::size_t>(kColumns) * n);
    base = heap_.data();
  }
  double** const columns[] = {&qx, &qy, &dx, &dy, &rx, &ry, &f, &w, &ux, &uy};
  for (double** column : columns) {
    *column = base;
    base += n;
  }
}

void ResidualColumns::choose_unit() {
  if (!(now_extent_ > 0) || (now_extent_ > kSmallExtent && now_extent_ < 1 / kSmallExtent)) return;
  int exponent = 0;
  std::frexp(now_extent_, &exponent);
  unit_px_ = std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
  for (int i = 0; i < n; ++i) {
    dx[i] /= unit_px_;
    dy[i] /= unit_px_;
  }
  now_extent_ /= unit_px_;
}

void ResidualColumns::whiten(Whitening whitening) {
  double sx = root_mean_square(qx, n), sy = root_mean_square(qy, n);
  if (whitening == Whitening::Uniform) sx = sy = std::sqrt(sx * sx + sy * sy);
  if (whitening == Whitening::Full) sx = sy = std::max(sx, sy);
  if (!(sx > 0 && sy > 0)) return;
  t00_ = 1 / sx;
  t11_ = 1 / sy;
  for (int i = 0; i < n; ++i) {
    qx[i] *= t00_;
    qy[i] *= t11_;
  }
  spans_ = true;
  if (whitening == Whitening::Full) orthogonalise();
}

// Gram-Schmidt on the columns, the longer one first. The second pass restores the orthogonality that the
// first loses on nearly collinear points; squaring into a covariance matrix would lose it for good.
void ResidualColumns::orthogonalise() {
  const bool x_first = sum_of_products(qx, qx, n) >= sum_of_products(qy, qy, n);
  double *a = x_first ? qx : qy, *b = x_first ? qy : qx;
  const double norm_a = root_mean_square(a, n);
  for (int i = 0; i < n; ++i) a[i] /= norm_a;
  double overlap = 0;
  for (int pass = 0; pass < 2; ++pass) {
    const double along = sum_of_products(a, b, n) / n;
    for (int i = 0; i < n; ++i) b[i] -= along * a[i];
    overlap += along;
  }
  const double norm_b = root_mean_square(b, n);
  spans_ = norm_b > kNoWidth;
  if (!spans_) return;
  for (int i = 0; i < n; ++i) b[i] /= norm_b;
  // a' = a / norm_a, b' = (b - overlap a') / norm_b, written in terms of x and y.
  const double scale = t00_;
  const double aa = scale / norm_a, bb = scale / norm_b, ba = -overlap * aa / norm_b;
  t00_ = x_first ? aa : bb;
  t01_ = x_first ? 0 : ba;
  t10_ = x_first ? ba : 0;
  t11_ = x_first ? bb : aa;
}

Affine2 ResidualColumns::whitening() const {
  return {t00_, t01_, -(t00_ * then_centre_.x + t01_ * then_centre_.y),
          t10_, t11_, -(t10_ * then_centre_.x + t11_ * then_centre_.y)};
}

Affine2 ResidualColumns::in_pixels(const Affine2& map) const {
  Affine2 out{unit_px_ * (map.a * t00_ + map.b * t10_), unit_px_ * (map.a * t01_ + map.b * t11_), 0,
              unit_px_ * (map.c * t00_ + map.d * t10_), unit_px_ * (map.c * t01_ + map.d * t11_), 0};
  const dvec2 moved = out.linear(then_centre_);
  out.tx = (now_centre_.x - moved.x) + unit_px_ * map.tx;
  out.ty = (now_centre_.y - moved.y) + unit_px_ * map.ty;
  return out;
}

}  // namespace talisman::warp
