// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does accuracy cost in time, for the whole pipeline? Every setting of settings.h on the same
/// frames.
///
/// Plans are made of every frame of the range, pictures of those that sampled_frames.h chooses and of their
/// predecessors: frame f for quality and time, f - 1 and f for popping. A sprite that was planned for a frame
/// between is drawn when f - 1 needs it (step.h), outside of all that is timed.
///
/// Frame by frame all settings advance side by side; the frame of `reference`, the first of them, is the
/// truth of the others and is drawn once. Memory: sprites and two pictures per setting, numbers of a few
/// hundred bytes per frame; the oracle besides keeps the states of its layers over the whole sequence.
///
/// Times are measured on this machine and differ from run to run; all other numbers are the same in every
/// run.

#include <vector>

#include "sequences/experiments/regulator/setting_run.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// Polygons of all layers in view, mean over the frames: what `reference` draws.
double reference_polygons_per_frame(const Sequence& sequence, const Settings& settings,
                                    const ExperimentFrames& frames);

/// One result per setting, in their order; the first must be `reference` (programmer error otherwise).
/// `settings` holds all that the settings of the regulator do not say. Cost: per drawn frame and setting one
/// or two frames of rendering and one comparison (0.1 s at 512 × 512).
std::vector<SettingResult> measure_regulator(const Sequence& sequence, const Settings& settings,
                                             const std::vector<RegulatorSetting>& compared,
                                             const ExperimentFrames& frames, ProgressKind progress);

}  // namespace talisman::sequences
