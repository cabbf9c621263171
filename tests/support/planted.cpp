// SPDX-License-Identifier: Apache-2.0
#include "tests/support/planted.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace talisman::tests {
namespace {

/// A vector m ≠ 0 with Σ mᵢ columnᵢ = 0, by elimination with complete pivoting; for one column more than the
/// rank.
std::vector<double> null_vector(std::vector<std::vector<double>> columns) {
  const int n = static_cast<int>(columns.size()), rows = static_cast<int>(columns[0].size());
  std::vector<int> order(n);
  for (int i = 0; i < n; ++i) order[i] = i;
  const auto at = [&](int row, int column) -> double& { return columns[order[column]][row]; };
  for (int k = 0; k < n - 1; ++k) {
    int row = k, column = k;
    for (int i = k; i < rows; ++i)
      for (int j = k; j < n; ++j)
        if (std::abs(at(i, j)) > std::abs(at(row, column))) row = i, column = j;
    std::swap(order[k], order[column]);
    for (auto& c : columns) std::swap(c[k], c[row]);
    for (int i = k + 1; i < rows; ++i) {
      const double factor = at(i, k) / at(k, k);
      for (int j = k; j < n; ++j) at(i, j) -= factor * at(k, j);
    }
  }
  std::vector<double> m(n);
  m[order[n - 1]] = 1;
  for (int k = n - 2; k >= 0; --k) {
    double sum = 0;
    for (int j = k + 1; j < n; ++j) sum += at(k, j) * m[order[j]];
    m[order[k]] = -sum / at(k, k);
  }
  return m;
}

Planted planted(std::uint64_t seed, int points, int support, const dmat3& map) {
  Random random(seed * 7919 + 3);
  Planted out;
  out.optimum_px = random.log_uniform(0.01, 20);
  const double angle = random.uniform(0, 6.28);
  const dvec2 e{std::cos(angle), std::sin(angle)};
  std::vector<std::vector<double>> columns;
  std::vector<dvec2> images;
  for (int i = 0; i < points; ++i) {
    const dvec2 p = dvec2{512, 512} + random.in_square(150), image = through(map, p);
    out.pairs.then_px.push_back(p);
    images.push_back(image);
    if (i >= support) continue;
    const dvec2 q = (p - dvec2{512, 512}) / 100.0;
    columns.push_back({1, q.x, q.y});
    const double along = glm::dot(e, image - dvec2{512, 512}) / 100.0;
    if (support > 4) columns.back().insert(columns.back().end(), {along, along * q.x, along * q.y});
  }
  const std::vector<double> m = null_vector(columns);
  for (int i = 0; i < points; ++i) {
    const double far = i < support ? 1 : random.uniform(0, 0.999), turn = random.uniform(0, 6.28);
    const dvec2 residual = i < support ? e * (m[i] < 0 ? -1.0 : 1.0) : dvec2{std::cos(turn), std::sin(turn)};
    out.pairs.now_px.push_back(images[i] + out.optimum_px * far * residual);
  }
  return out;
}

}  // namespace

Planted planted_affine(std::uint64_t seed, int points) {
  return planted(seed, points, 4, layers::to_mat3(gentle_affine(seed)));
}

Planted planted_perspective(std::uint64_t seed, int points) {
  return planted(seed, points, 6, gentle_perspective(seed));
}

}  // namespace talisman::tests
