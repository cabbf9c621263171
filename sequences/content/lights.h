// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The lights of a sequence file. Colours are linear light times `intensity`, a factor without unit: white with
/// intensity 1 that falls squarely on white makes white, at any distance.

#include <optional>

#include "sequences/content/motion.h"

namespace talisman::sequences {

struct LightRecipe {
  layers::Light light;   ///< in the space of `motion`, where it has one; its colour without intensity
  double intensity = 1;  ///< ≥ 0
  Motion motion;
  bool moves = false;  ///< has its own node; else it stands in the world
};

const Table<LightRecipe>& light_keys();

}  // namespace talisman::sequences
