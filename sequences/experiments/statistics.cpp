// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

/// Of finite numbers; 0 where one side is constant. The sums are of half-integers and exact in any order.
double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  const double mean = (n + 1) / 2;  // of ranks, ties or not
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - mean, dy = y[i] - mean;
    xy += dx * dy, xx += dx * dx, yy += dy * dy;
  }
  return xx > 0 && yy > 0 ? std::clamp(xy / (std::sqrt(xx) * std::sqrt(yy)), -1.0, 1.0) : 0;
}

bool is_constant(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

}  // namespace

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const double shared = (static_cast<double>(first + 1) + static_cast<double>(end)) / 2;
    for (; first < end; ++first) result[order[first]] = shared;
  }
  return result;
}

RankCorrelation spearman(std::span<const double> x, std::span<const double> y) {
  TALISMAN_CHECK_EQ(x.size(), y.size());
  std::vector<double> finite_x, finite_y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    finite_x.push_back(x[i]);
    finite_y.push_back(y[i]);
  }
  RankCorrelation result;
  result.n = static_cast<int>(finite_x.size());
  result.defined = result.n >= 2 && !is_constant(finite_x) && !is_constant(finite_y);
  if (result.defined) result.rho = pearson(ranks(finite_x), ranks(finite_y));
  return result;
}

double quantile(std::span<const double> values, double q) {
  TALISMAN_CHECK(q >= 0 && q <= 1);
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double v) { return std::isfinite(v); });
  if (sorted.empty()) return 0;
  std::sort(sorted.begin(), sorted.end());
  const double place = q * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double median(std::span<const double> values) { return quantile(values, 0.5); }

std::vector<bool> pareto_front(const std::vector<double>& cost, const std::vector<double>& error,
                               double least_gain) {
  TALISMAN_CHECK_EQ(cost.size(), error.size());
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < cost.size(); ++k)
    if (!std::isnan(cost[k]) && !std::isnan(error[k])) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b];
  });
  std::vector<bool> front(cost.size(), false);
  double best = HUGE_VAL;
  for (const std::size_t k : order)
    if (error[k] < best * (1 - least_gain)) front[k] = true, best = error[k];
  return front;
}

double rms_code_values(double psnr_db) { return 255 * std::pow(10, -psnr_db / 20); }

}  // namespace talisman::sequences
