// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does this build have all the effects that a run calls for? A build may leave effects out
/// (layers/effect.h); a scene that calls for one of those is refused before its first frame, since a picture
/// without it would be wrong and nobody would know.

#include <span>
#include <string>

#include "layers/effects.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// "calls for shadow_map (light 'spot': static, drawn once), which this build was configured without
/// (TALISMAN_WITHOUT)", of the first effect of `table` that is called for and not in `built`; empty if there
/// is none.
std::string missing_effect(std::span<const layers::EffectCall> table, const layers::EffectSet& built);

/// Throws InputError, "NAME: " before the text above, if the run calls for an effect that this build lacks.
void require_built_effects(const Sequence& sequence, const Settings& settings);

/// The effects that this build has.
layers::EffectSet built_effects();

}  // namespace talisman::sequences
