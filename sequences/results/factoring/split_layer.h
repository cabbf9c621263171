// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What if a layer were split? The same sequence with each part of it as a layer of its own, planned beside what it is
/// now: how much would be drawn, and what would be merged again because the pieces hide each other.
///
/// A piece has the group, preferences, shading, fade and shadows of its layer, and the name of its part; pairs of `order`
/// that name the layer hold for every piece. Both are plans: no pixel is drawn, and times are modelled. What a finer
/// factoring does to the picture (resampling at more borders) a plan does not say.

#include <string>
#include <vector>

#include "sequences/results/planned.h"

namespace talisman::sequences {

/// Each piece is planned in every frame; more would say less.
inline constexpr std::size_t kMostPieces = 64;

struct SplitSequence {
  Sequence sequence;
  std::vector<std::string> pieces;  ///< names, of the layers that took the place of the one
};

/// Throws InputError: no layer of an author has that name, or it has one part, or more than kMostPieces.
SplitSequence split_layer(const Sequence& sequence, const std::string& layer);

/// Both summaries side by side: the layer and its pieces, then the sums of the whole run.
std::string split_table(const Summary& now, const Summary& split, const std::string& layer,
                        const std::vector<std::string>& pieces);

}  // namespace talisman::sequences
