// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How wrong are the frames, in the mean over their layers? [LS97 7.2, Fig. 23]
///
/// Held triple framing is a saw-tooth of three frames: 0 where all is drawn, half its height in the next frame, all of
/// it in the third. Thresholds stay below themselves. What makes the comparison of Fig. 22 fair is that every
/// threshold is smaller than the largest error of triple framing.

#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct ThresholdError {
  double threshold_px = 0;
  std::vector<double> mean_px;  ///< by frame, over its layers
  double largest_px = 0;        ///< of any layer in any frame
};

/// Means by frame, over the layers in view (FrameError::mean_px).
struct PixelErrors {
  std::vector<double> held_px, interpolated_px;
  std::vector<ThresholdError> thresholds;  ///< ascending
};

/// Beats whose middle frame has `share` of the error of the third, which has some: to ± kSawTooth of a half.
inline constexpr double kSawTooth = 0.2;
/// Of whole beats of three frames, from frame 0 on.
struct SawTooth {
  double largest_at_beat_px = 0;  ///< of the frames in which all is drawn
  double middle = 0;              ///< sum of the middle frames over that of the third ones; 0 without error
  int beats = 0, beats_in_shape = 0;  ///< that have an error; of them those with a middle of ½ ± 20 %
};
SawTooth saw_tooth_of(const std::vector<double>& held_px);

/// 0, ½, full to ± 20 %: of the sums, and of four beats in five.
Finding is_saw_tooth(const PixelErrors& errors);
/// The mean of no frame, and the error of no layer, is above the threshold.
Finding thresholds_are_kept(const PixelErrors& errors);
/// Held triple framing has a frame whose mean is above the largest threshold.
Finding premise_holds(const PixelErrors& errors);
/// Warped between the beats, triple framing is less wrong: by half or more, in the mean over the frames.
Finding interpolation_is_better(const PixelErrors& errors);

Item figure_23();

}  // namespace talisman::sequences
