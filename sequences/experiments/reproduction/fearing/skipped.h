// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How much is not drawn again, if some things move all the time and the others never? [F96 Tables 5.26, 5.30]
///
/// Of F frames in slices of N, what rests is drawn ⌈F / N⌉ times, and what moves F times. With s the share at rest,
///
///   skipped = s (1 - ⌈F / N⌉ / F)
///
/// which is what the paper prints to the last digit: here it is the oracle, and the cells are counted from the words of a
/// run over the scenario "random" (content/swarm), and from what its plan draws. The clip rule is off, as in the paper.
/// The control row of Table 5.26, 100 % skipped, is a misprint for 0.

#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// Columns and rows of the tables.
inline constexpr int kMovingPercent[] = {100, 75, 50, 25, 1};
inline constexpr int kSlices96[] = {2, 4, 8, 16, 32};

/// The closed form, 0 … 1.
double skipped_share(double rest, int frames, int slice);

struct SkippedCell {
  int moving_percent = 0, slice = 0;
  double printed = 0;  ///< per cent
  double counted = 0;  ///< likewise
  double oracle = 0;
};

/// Every cell is the printed one and the oracle's, to the second digit.
Finding table_5_26(const std::vector<SkippedCell>& cells);
/// Bounds 1 / (1 - skipped) of N = 32 and 1 / (1 - s), from the counted cells: as printed, rounded or cut off.
Finding bounds_5_30(const std::vector<SkippedCell>& cells);

Item skipped_polygons_96();

}  // namespace talisman::sequences
