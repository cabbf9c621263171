// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a policy that looks ahead keep of each frame that it looked at (PipelineState::captured)?

#include <cstdint>

#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Bytes, by the lengths of what is kept: the same on every run.
std::int64_t bytes_of(const CapturedFrame& frame);

/// Frames that are kept at most at one time: those of a sequence of `frames` that the policy may look at from one of them.
std::int64_t most_frames_kept(const regulator::RegulatorOptions& options, int frames);

}  // namespace talisman::sequences
