// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The few dense operations that the maximum-norm fits need, for sizes of 2 to 8: no heap, fixed order of
/// summation.

#include <array>
#include <cmath>

namespace talisman::warp {

template <int D>
using Vec = std::array<double, D>;
template <int D>
using Mat = std::array<std::array<double, D>, D>;

template <int D>
double dot(const Vec<D>& a, const Vec<D>& b) {
  double sum = 0;
  for (int k = 0; k < D; ++k) sum += a[k] * b[k];
  return sum;
}

template <int D>
void add_scaled(Vec<D>& sum, double factor, const Vec<D>& v) {
  for (int k = 0; k < D; ++k) sum[k] += factor * v[k];
}

/// Lower triangle of m += factor · v vᵀ.
template <int D>
void add_outer(Mat<D>& m, double factor, const Vec<D>& v) {
  for (int i = 0; i < D; ++i) {
    const double scaled = factor * v[i];
    for (int j = 0; j <= i; ++j) m[i][j] += scaled * v[j];
  }
}

/// H = L Lᵀ; reads and keeps the lower triangle only, and the reciprocals of L's diagonal in place of the diagonal,
/// because each is divided by more often than it is made.
template <int D>
struct Cholesky {
  Mat<D> lower;

  /// False if a pivot is not above `tiny_pivot` times its diagonal entry: numerically not positive definite.
  bool factor(const Mat<D>& h, double tiny_pivot) {
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < i; ++j) {
        double sum = h[i][j];
        for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        lower[i][j] = sum * lower[j][j];
      }
      double pivot = h[i][i];
      for (int k = 0; k < i; ++k) pivot -= lower[i][k] * lower[i][k];
      if (!(pivot > tiny_pivot * h[i][i])) return false;
      lower[i][i] = 1 / std::sqrt(pivot);
    }
    return true;
  }
  /// v becomes L⁻¹ v.
  void forward(Vec<D>& v) const {
    for (int i = 0; i < D; ++i) {
      for (int k = 0; k < i; ++k) v[i] -= lower[i][k] * v[k];
      v[i] *= lower[i][i];
    }
  }
  /// v becomes L⁻ᵀ v.
  void backward(Vec<D>& v) const {
    for (int i = D - 1; i >= 0; --i) {
      for (int k = i + 1; k < D; ++k) v[i] -= lower[k][i] * v[k];
      v[i] *= lower[i][i];
    }
  }
  void solve(Vec<D>& v) const {
    forward(v);
    backward(v);
  }
};

}  // namespace talisman::warp
