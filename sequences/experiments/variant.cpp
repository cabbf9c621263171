// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/variant.h"

#include "sequences/pipeline/run_effects.h"

namespace talisman::sequences {

std::vector<layers::EffectCall> effects_of(const Sequence& sequence, const Settings& settings) {
  return layers::effects_called_for(*sequence.scene, sequence.layers.layers, run_effects(settings));
}

std::vector<layers::EffectCall> effects_of(const Variant& variant) {
  return effects_of(variant.sequence, variant.settings);
}

layers::EffectCall effect_call(const Variant& variant, layers::Effect effect) {
  for (layers::EffectCall& call : effects_of(variant))
    if (call.effect == effect) return call;
  return {};
}

}  // namespace talisman::sequences
