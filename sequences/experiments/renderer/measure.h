// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does drawing these variants of a sequence take, side by side?
///
/// In every round every frame is drawn by every variant before the next frame comes, in one process: what the
/// machine does besides falls on all of them alike. A time is the median over the rounds of the mean over the
/// frames; its spread is the median deviation from it. Counters and pictures are those of the first round;
/// they are the same in all.
///
/// Either each frame is drawn from nothing (shadow maps and all sprites included), or a run goes through a
/// range of frames under its policy and begins with the first of them.

#include <vector>

#include "sequences/experiments/renderer/measured.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// One result per variant, in their order. Memory: the pictures that are kept, and what the variants' sprites
/// and textures take. Scenes that variants share are prepared once.
std::vector<Measured> measure_variants(const std::vector<const Variant*>& variants, const Workload& workload,
                                       Progress& progress);
/// Steps that `progress` must have.
int steps_of(std::size_t variants, const Workload& workload);

/// Same number of pictures (programmer error otherwise).
PictureError error_of(const std::vector<Image8>& shown, const std::vector<Image8>& truth);

}  // namespace talisman::sequences
