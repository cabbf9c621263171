// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence file as data. Its format is described in docs/sequence-format.md.

#include <optional>
#include <string>
#include <vector>

#include "sequences/content/factoring/cuts.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/content/layer_keys.h"
#include "sequences/content/layer_pairs.h"
#include "sequences/content/scene_recipe.h"
#include "sequences/content/sequence.h"

namespace talisman::sequences {

struct SequenceFile {
  Sequence settings;  ///< without scene and layers
  SceneRecipe recipe;
  std::vector<CutEntry> cuts;             ///< of parts, before anything is factored
  std::vector<LayerEntry> layers;         ///< empty: one per moving or top-level node, or as the next says
  std::optional<AutoLayers> auto_layers;  ///< how they are found, where none are written
  std::vector<LayerPairEntry> order;
};

/// The keys at the top of a file, from which all others are reached.
const Table<SequenceFile>& sequence_keys();

/// Reads and checks the whole file, and that the assets it names are there. Throws InputError.
SequenceFile read_sequence_file(const std::string& file);

}  // namespace talisman::sequences
