// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/moving_average.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "layers/check.h"

namespace talisman::sequences {

std::vector<double> moving_average(const std::vector<double>& values, int window) {
  TALISMAN_CHECK_GE(window, 1);
  std::vector<double> averages;
  // Each window by itself: a running sum would carry the rounding of one into the next.
  for (std::size_t k = 0; k + static_cast<std::size_t>(window) <= values.size(); ++k)
    averages.push_back(std::accumulate(values.begin() + k, values.begin() + k + window, 0.0) / window);
  return averages;
}

std::vector<double> shares_of(const std::vector<double>& values, const std::vector<double>& whole) {
  TALISMAN_CHECK_EQ(values.size(), whole.size());
  std::vector<double> shares;
  for (std::size_t k = 0; k < values.size(); ++k)
    shares.push_back(whole[k] == 0 ? std::numeric_limits<double>::quiet_NaN() : values[k] / whole[k]);
  return shares;
}

double mean_of(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) return HUGE_VAL;
    largest = k == 0 ? values[k] : std::max(largest, values[k]);
  }
  return largest;
}

}  // namespace talisman::sequences
