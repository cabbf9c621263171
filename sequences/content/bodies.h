// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The bodies of a sequence file: simple shapes and models from files, each alone or in several instances.

#include "sequences/content/scene_recipe.h"

namespace talisman::sequences {

const Table<ShapeRecipe>& shape_keys();
const Table<ModelRecipe>& model_keys();

}  // namespace talisman::sequences
