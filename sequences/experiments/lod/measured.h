// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a level of detail buy? The selectors of [Fu93 4.5] on one sequence (regulator/lod/): how even the times of its
/// frames are, and how far the pictures are from full detail.
///
///   none       every layer, every frame, at its finest level
///   static     likewise, at the level whose triangles are large enough
///   feedback   likewise, as large as the time of the last frame asks for, at each target
///   optimise   within each target: levels, resolutions, and which old sprites are kept, by the error and as printed
///
/// The first target is `--budget-ms` of the sequence, else the mean of static, so that quality can be compared at equal
/// time; the second is half of it. Times of frames are modelled (`modelled_drawing_ms`, talisman-1996); wall times are this
/// machine's, of the frames that are drawn.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/measured.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

/// Of the frames of a run, ms; of none all are 0.
struct FrameSpread {
  double min = 0, mean = 0, max = 0, sigma = 0;
};
FrameSpread frame_spread_of(const std::vector<double>& ms);

struct LodResult {
  std::string name;
  double target_ms = 0;  ///< 0: none
  FrameSpread modelled;
  int frames_above = 0;                    ///< target
  int frames_unfit = 0;                    ///< of these, the coarsest pictures alone exceed it
  std::int64_t switched = 0, skipped = 0;  ///< levels that changed with a render; layers in view not shown
  double share_of_bound = 1;               ///< of the benefit, of optimise
  SettingResult measured;  ///< its means are over the frames that are drawn, its counts over all
};

struct LodExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  int levels = 1;  ///< the most of any layer
  std::vector<LodResult> results;
  std::vector<std::vector<double>> modelled_ms;  ///< by result: of each frame
};

/// `settings`: all but the policy and the selector, which are varied.
LodExperiment measure_lod(const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames,
                          ProgressKind progress);

/// lod.csv, a plot of the times of frames; what is printed and lod.html (published.h).
void write_report(const LodExperiment& experiment, const std::string& dir);
Page page_of(const LodExperiment& experiment);

}  // namespace talisman::sequences
