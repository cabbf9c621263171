// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which thresholds of single layers could be tried next? Plans of the neighbours of a setting, all by a factor of
/// 2 or √2:
///
///   one layer looser
///   all looser but one
///   all looser but one, and that one stricter
///
/// (for the other way: stricter where it says looser, and looser where it says stricter). Of many layers the
/// kMostMoved dearest are those that are moved one by one.

#include <vector>

#include "sequences/experiments/tuning/thresholds.h"

namespace talisman::sequences {

inline constexpr std::size_t kMostMoved = 6;

enum class MoveTowards { Looser, Stricter };

/// The neighbours that gain 1 % or more: in cost (Looser), the cheapest first; or in displayed error (Stricter), the
/// least first. Cost: at most 36 plans.
std::vector<PlannedThresholds> layer_moves(const Sequence& sequence, const Settings& settings,
                                           const FrameRange& range, MoveTowards towards,
                                           const PlannedThresholds& here);

}  // namespace talisman::sequences
