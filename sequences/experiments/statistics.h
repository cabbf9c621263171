// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Do two quantities rise together? Spearman's rank correlation, and order statistics.
///
///   ρ = Pearson's correlation of the ranks            -1 … 1, no unit
///     = 1 - 6 Σ dᵢ² / (n (n² - 1))                    without ties, dᵢ the difference of the ranks
///
/// Equal values share the mean of the ranks that they take up. 1: whatever is larger in x is larger in y,
/// however curved the relation; 0: nothing is known of y from x.

#include <span>
#include <vector>

namespace talisman::sequences {

/// Ranks 1 … n in the order of `values`, all of them finite; ties share their mean rank. Cost: O(n log n).
std::vector<double> ranks(std::span<const double> values);

struct RankCorrelation {
  bool defined = false;  ///< false: fewer than two pairs, or one of the quantities is constant
  double rho = 0;        ///< 0 where it is not defined
  int n = 0;             ///< pairs of finite numbers; the others are left out
};

/// Same lengths (programmer error otherwise).
RankCorrelation spearman(std::span<const double> x, std::span<const double> y);

/// The value below which the share `q` (0 … 1) of the finite values lies, interpolated between neighbours; 0
/// if there are none. The median is quantile(values, 0.5).
double quantile(std::span<const double> values, double q);

}  // namespace talisman::sequences
