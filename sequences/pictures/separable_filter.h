// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Separable filters on planes of floats, for the picture metrics.
///
///   rows:     out(x, y) = Σₖ wₖ · in(x + k, y)      k = -radius … radius
///   columns:  out(x, y) = Σₖ wₖ · in(x, y + k)
///
/// Outside the plane the nearest inside sample counts (replicated border). A kernel is even (w₋ₖ = wₖ: blurs,
/// second derivatives) or odd (w₋ₖ = -wₖ: first derivatives), so that mirrored samples share one
/// multiplication. The order of the sum is fixed: the same bytes for any number of threads.

#include <cmath>
#include <functional>
#include <vector>

namespace talisman::sequences {

struct Plane {
  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h) {}
  int width = 0, height = 0;
  std::vector<float> values;  ///< row by row
  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }
};

struct Kernel {
  std::vector<float> weights;  ///< w₀ … w_radius; at least w₀
  bool odd = false;            ///< then w₀ is not used
  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// Samples of exp(-k² / 2σ²), sum 1. σ in pixels, > 0.
Kernel gaussian_kernel(double sigma_px, int radius);

/// Cost: width · height · (radius + 1) multiplications.
Plane filter_rows(const Plane& in, const Kernel& kernel);
Plane filter_columns(const Plane& in, const Kernel& kernel);
/// Rows, then columns, with the same kernel.
Plane blur(const Plane& in, const Kernel& kernel);

/// Calls `row(y)` for every row, on all threads.
void for_each_row(int height, const std::function<void(int)>& row);

}  // namespace talisman::sequences
