// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Levels of detail of a sequence (layers/lod/levels.h), where a selector asks for them: in the file (`lod`), or on the
/// command line.

#include "sequences/content/sequence.h"

namespace talisman::sequences {

/// Its scene gets the parts of all levels; its layers stay as they are. Cost: that of layers::with_levels, and a copy of
/// the scene.
void add_levels(Sequence& sequence);

}  // namespace talisman::sequences
