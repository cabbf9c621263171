// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which effects does a run ask for by its settings alone?

#include "layers/effects.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// What the settings ask for, whatever the scene.
layers::RunEffects run_effects(const Settings& settings);

}  // namespace talisman::sequences
