// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence and how it is run: what experiments change, and what calls for effects.

#include <vector>

#include "layers/effects.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// A plain value; the scene is shared until it is changed.
struct Variant {
  Sequence sequence;  ///< needs its layer_specs
  Settings settings;
};

/// The table of layers/effects.h for this sequence under these settings, of which those matter that say how
/// sprites are kept, how textures are filtered, and whether the light is followed.
std::vector<layers::EffectCall> effects_of(const Sequence& sequence, const Settings& settings);
std::vector<layers::EffectCall> effects_of(const Variant& variant);

/// One row of it.
layers::EffectCall effect_call(const Variant& variant, layers::Effect effect);

}  // namespace talisman::sequences
