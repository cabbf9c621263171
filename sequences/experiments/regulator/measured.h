// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman accuracy --regulator` has measured: of every setting, what it cost and how far it is from
/// the truth; of lookahead, what each frame known ahead saves; of fiducials, what they say of the picture.
/// Data alone: what prints it looks down on it.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/experiments/regulator/calibration.h"
#include "sequences/experiments/regulator/lookahead_curve.h"
#include "sequences/experiments/regulator/popping.h"
#include "sequences/experiments/regulator/settings.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Milliseconds per frame.
struct Timing {
  double mean = 0;    ///< what a frame costs over a run
  double median = 0;  ///< what most frames cost; 0 ms of rendering where most frames render nothing
};

struct SettingResult {
  RegulatorSetting setting;
  // From the plan of all frames.
  double mean_update_rate = 0, weighted_update_rate = 0;  ///< 0 … 1; weighted by polygons
  std::int64_t renders = 0, polygons = 0, pixels = 0, chunks = 0;
  double mean_geometric_px = 0, max_geometric_px = 0;  ///< of what is displayed
  Timing plan;
  // From the frames that are drawn.
  Timing render, composite;
  double modelled_ms = 0;  ///< mean, by the profile talisman-1996
  Quality quality;         ///< mean against `reference`; PSNR of the mean squared error
  Popping popping;
  double frame_ms() const { return plan.mean + render.mean + composite.mean; }
};

struct RegulatorReport {
  Settings given;  ///< what is not varied is as it is here
  std::string sequence, warp;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  std::vector<SettingResult> settings;  ///< `reference` first
  std::vector<std::string> runs;        ///< of each what it opens (stored_runs.h); empty: nothing is stored
  double runs_s = 0, runs_mb = 0;       ///< what storing them took
  LookaheadCurve lookahead;
  std::vector<std::string> layers;  ///< names, by id
  std::vector<CalibrationSample> samples;
  std::vector<CalibrationSummary> calibration;
};

}  // namespace talisman::sequences
