// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Do two quantities rise together? Spearman's rank correlation, order statistics, and which of several
/// settings is worth its cost.
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
/// if there are none.
double quantile(std::span<const double> values, double q);
double median(std::span<const double> values);  ///< quantile(values, 0.5)

/// Which of the points are not beaten by another one that is as good in both and better in one; small is
/// good. Of equal points the first counts; not-a-number is on no front. What improves the error of the
/// cheaper ones by less than the share `least_gain` (0 … 1) improves nothing; errors ≥ 0 then. Same lengths
/// (programmer error otherwise). Cost: O(n log n).
std::vector<bool> pareto_front(const std::vector<double>& cost, const std::vector<double>& error,
                               double least_gain = 0);

/// Root of the mean squared error of 8-bit pictures, code values of 255, from their PSNR; 0 for an infinite
/// one.
double rms_code_values(double psnr_db);

}  // namespace talisman::sequences
