// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/levels.h"

#include <utility>

#include "layers/lod/levels.h"

namespace talisman::sequences {

void add_levels(Sequence& sequence) {
  layers::SceneWithLevels made = layers::with_levels(*sequence.scene, sequence.layers);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(made.scene));
  sequence.levels = std::make_shared<const layers::LevelSet>(std::move(made.levels));
}

}  // namespace talisman::sequences
