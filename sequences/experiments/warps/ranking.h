// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp needs fewer renders, and does it agree with the paper? [LS97 4.2]
///
/// The merit of a curve in a figure is the mean over thresholds of the logarithm of its update rate, relative
/// to that of `aff`:
///
///   merit(c) = mean over t of ln(rate_c(t) / rate_aff(t)),       ratio(c) = exp(merit(c))
///
/// over those thresholds at which `aff` renders more than once and less than every frame: elsewhere all
/// curves are alike. A ratio of 2 means twice as many renders as affine. Sorted by merit, neighbours whose
/// merits differ by less than ln(1 + tolerance) are in one cluster.

#include <string>
#include <string_view>
#include <vector>

#include "sequences/experiments/warps/update_rate.h"

namespace talisman::sequences {

/// Curves whose update rates differ by less than this, in the mean, are called alike.
inline constexpr double kAlike = 0.10;

struct CurveMerit {
  warp::Curve curve{};
  double ratio = 1;  ///< update rate relative to aff, geometric mean; > 0
};

struct Ranking {
  std::vector<CurveMerit> merits;                  ///< most renders first
  std::vector<std::vector<warp::Curve>> clusters;  ///< the same order
  int thresholds_used = 0;                         ///< 0: nothing could be compared, all ratios are 1
  double ratio(warp::Curve curve) const;
};
Ranking rank(const std::vector<UpdateCurve>& curves, double tolerance = kAlike);

/// "trn trni | so soi | aff …", most renders first.
std::string in_words(const Ranking& ranking);

enum class Agreement {
  Yes,
  OrderOnly,  ///< the order is the paper's, but the curves are closer than the tolerance
  No,
};
std::string_view name(Agreement agreement);

/// What the paper says, what this run says, and whether they agree. Orders are compared within one norm: what
/// the norm itself changes is a statement of its own.
struct Statement {
  std::string paper, ours;
  Agreement agreement = Agreement::No;
};

/// On Fig. 15 (flat teapot): the clusters translation, x/y scale, Shade, affine, perspective in order of
/// merit; sum of squares hardly different from maximum.
std::vector<Statement> compare_with_figure_15(const Ranking& ranking);
/// On Fig. 16 (regular teapot): the clusters translation, x/y scale, all others; Shade slightly worse than
/// affine; perspective no better than affine; sum of squares hardly different from maximum.
std::vector<Statement> compare_with_figure_16(const Ranking& ranking);

}  // namespace talisman::sequences
