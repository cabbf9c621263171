// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small workloads as sequences, for what runs on whole sequences.

#include "sequences/content/sequence.h"
#include "sequences/experiments/effect_removal.h"

namespace talisman::tests {

/// moving_scene (scenes.h), one layer per part, on a display of 96 × 72. Its motion takes 96 frames.
sequences::Sequence moving_sequence(int frames);

/// cube_scene, in which nothing moves, likewise.
sequences::Sequence resting_sequence(int frames);

/// What `talisman render` makes of a sequence without any option.
sequences::Variant run_of(const sequences::Sequence& sequence);

/// A sequence that calls for all effects (layers/effects.h) but predictive, and needs no package: a mirroring floor with two
/// textures and all shade layers, a ball that spins, a pane that crosses with an open shutter, a bar that
/// bends, a lamp that sways and casts shadows, a camera that flies past; sprites are compressed. 96 × 72,
/// threshold 1 px.
sequences::Variant every_effect(int frames);

/// A sequence that calls for this effect: every_effect, but for the policy predictive. That draws nothing that mirrors
/// or can be seen through, so it is moving_sequence's.
sequences::Variant calling_for(layers::Effect effect, int frames);

}  // namespace talisman::tests
