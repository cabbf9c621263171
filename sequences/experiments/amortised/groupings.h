// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The same scene in other layers: one for each part, one for each group of the order, or any partition.
///
/// Each new layer has the group and the wishes of the author's layer that its parts came from; shading that had layers of its
/// own is in the surface again. Where the bounds of two parts know no order, it is the one in which they are seen
/// (content/factoring/seen_order.h). Parts of one name stay together, since they are named by globs.

#include <optional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Empty: there are more than kMostParts.
std::optional<Sequence> one_layer_per_part(const Sequence& sequence, const Settings& settings);
inline constexpr std::size_t kMostParts = 1000;

/// All layers of one group and one set of wishes in one.
Sequence one_layer_per_group(const Sequence& sequence);

/// `set_of`: by layer of `sequence`, which has no shade layers, the number of the set that it is in.
Sequence joined_layers(const Sequence& sequence, const std::vector<int>& set_of);

/// All ways to put `count` things into sets, each as the number of the set of each thing: restricted growth strings, in
/// lexicographic order. Bell(8) = 4140.
std::vector<std::vector<int>> partitions(int count);

}  // namespace talisman::sequences
