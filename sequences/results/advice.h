// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What could be done where a run saves little? Every line of advice is the outcome of a plan that was made for it.

#include <string>
#include <vector>

#include "sequences/results/planned.h"

namespace talisman::sequences {

/// A run that renders less than this share of the reference, in polygons or in pixels, needs no advice.
inline constexpr double kSavesLittle = 0.6;

/// At most three lines; none where the run saves enough, where its policy draws on no threshold, or where planning it
/// again would be long (layers × frames above kMostPlanned). Tried are
///   - of the dearest layer that is drawn for its geometry: 2, 3, 4, 6, 8 times the threshold, until it is drawn half as
///     often;
///   - where layers are merged: to keep them apart;
///   - policy lookahead instead of threshold.
/// Cost: at most seven plans.
std::vector<std::string> advice_for(const Sequence& sequence, const Settings& settings,
                                    const FrameRange& range, const Summary& run);
inline constexpr std::size_t kMostPlanned = 50'000;

}  // namespace talisman::sequences
