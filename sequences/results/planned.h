// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What would a run with these settings draw? A plan alone: no pixels, no files.

#include <functional>

#include "sequences/content/sequence.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

/// Frames A to B, inclusive.
struct FrameRange {
  int first = 0, last = 0;
};

/// Plans from frame 0 on, as every run does, and shows each frame of the range. The settings are as `resolve` makes
/// them, of this sequence.
void plan_frames(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                 const std::function<void(const FrameReport&, const PipelineState&)>& show);

/// The summary that `plan` would write, but for the times: seams are those that the settings need (content/seams.h). `also`
/// sees each frame of the range.
Summary planned(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                const std::function<void(const FrameReport&)>& also = nullptr);

}  // namespace talisman::sequences
