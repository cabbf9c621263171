// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/levels.h"

#include <memory>

#include "layers/lod/levels.h"

namespace talisman::sequences {

void add_levels(Sequence& sequence) {
  sequence.scene =
      std::make_shared<const layers::Scene>(layers::with_levels(*sequence.scene, sequence.layers));
}

}  // namespace talisman::sequences
