// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/missing_effects.h"

#include <algorithm>

#include "layers/built_effects.h"
#include "sequences/experiments/variant.h"
#include "sequences/files/errors.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

namespace {

constexpr layers::EffectSet kBuilt = layers::effects_without(TALISMAN_WITHOUT);
constexpr bool kHasAll = std::all_of(kBuilt.begin(), kBuilt.end(), [](bool built) { return built; });

}  // namespace

std::string missing_effect(std::span<const layers::EffectCall> table, const layers::EffectSet& built) {
  for (const layers::EffectCall& call : table)
    if (call.called && !built[static_cast<std::size_t>(call.effect)])
      return "calls for " + std::string(layers::name(call.effect)) + " (" + call.why +
             "), which this build was configured without (TALISMAN_WITHOUT)";
  return {};
}

void require_built_effects(const Sequence& sequence, const Settings& settings) {
  if constexpr (kHasAll) return;
  if (const std::string missing = missing_effect(effects_of(sequence, settings), kBuilt); !missing.empty())
    throw InputError(missing, sequence.name);
}

layers::EffectSet built_effects() { return kBuilt; }

}  // namespace talisman::sequences
