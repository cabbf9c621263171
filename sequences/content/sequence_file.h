// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence file as data. Its format is described in docs/sequence-format.md.

#include <string>
#include <vector>

#include "sequences/content/layer_pairs.h"
#include "sequences/content/scene_recipe.h"
#include "sequences/content/sequence.h"

namespace talisman::sequences {

struct LayerEntry {
  layers::LayerSpec spec;
  std::string file;  ///< and line: where it is written, for errors that show only with the scene
  int line = 0;
};

struct SequenceFile {
  Sequence settings;  ///< without scene and layers
  SceneRecipe recipe;
  std::vector<LayerEntry> layers;  ///< empty: one per moving or top-level node
  std::vector<LayerPairEntry> order;
};

/// Reads and checks the whole file, and that the assets it names are there. Throws InputError.
SequenceFile read_sequence_file(const std::string& file);

}  // namespace talisman::sequences
