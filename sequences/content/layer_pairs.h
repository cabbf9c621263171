// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The author's order of single layers: the list `order` of a sequence file, `{behind: GLOB, front: GLOB}`
/// over the names of layers. It takes precedence over geometry and yields to the groups.

#include <span>
#include <string>
#include <vector>

#include "layers/visibility.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

struct LayerPairEntry {
  std::string behind, front;  ///< globs
  std::string file;           ///< and line: where it is written
  int line = 0;
};

const Table<LayerPairEntry>& layer_pair_keys();

/// Every layer that `behind` matches with every other layer that `front` matches. Throws InputError for a
/// glob that matches no layer, an entry that names one layer twice and nothing else, and a pair that
/// contradicts the groups or the entries before it (with other pairs it would go round). Cost: O(pairs²) at
/// worst.
std::vector<layers::ExplicitPair> resolve_layer_pairs(std::span<const LayerPairEntry> entries,
                                                      std::span<const layers::Layer> layers);

/// Adds those of `more` that contradict neither the groups nor a pair that is there; the others are left out.
void add_free_pairs(std::span<const layers::ExplicitPair> more, std::span<const layers::Layer> layers,
                    std::vector<layers::ExplicitPair>& pairs);

}  // namespace talisman::sequences
