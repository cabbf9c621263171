// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small workloads as sequences, for what runs on whole sequences.

#include "sequences/sequence.h"

namespace talisman::tests {

/// moving_scene (scenes.h), one layer per part, on a display of 96 × 72. Its motion takes 96 frames.
sequences::Sequence moving_sequence(int frames);

/// cube_scene, in which nothing moves, likewise.
sequences::Sequence resting_sequence(int frames);

}  // namespace talisman::tests
