// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `layers: {auto: velocity, max: 40}` in a sequence file: layers that are found instead of written.

#include "sequences/content/factoring/factoring.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

const Table<AutoLayers>& auto_layers_keys();

}  // namespace talisman::sequences
