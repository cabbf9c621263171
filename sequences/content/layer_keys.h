// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The layers of a sequence file: which parts they take, what they may cost, and which terms of the shading are
/// sprites of their own.

#include <string>

#include "layers/layer.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

struct LayerEntry {
  layers::LayerSpec spec;
  std::string file;  ///< and line: where it is written, for errors that show only with the scene
  int line = 0;
};

const Table<LayerEntry>& layer_keys();

}  // namespace talisman::sequences
