// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman accuracy --factoring` has measured: how far each picture is from the unfactored truth, how
/// much of it was predicted, and what both sequences cost (experiment.h). Data alone: what prints it looks
/// down on it.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sequences/experiments/factoring/prediction.h"
#include "sequences/experiments/regulator/measured.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/pictures/diff.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Sum, and largest absolute value, of what is added in a fixed order.
struct ErrorSum {
  double squares = 0, largest = 0;
  std::int64_t count = 0;
  void add(double error);
  ErrorSum& operator+=(const ErrorSum& o);
  double rms() const;
};

/// Measured error against predicted error, over pixels and their channels; linear light, 1: white.
struct PredictionCheck {
  ErrorSum predicted;    ///< by the formula and the rest
  ErrorSum by_formula;   ///< by the paper's formula alone
  ErrorSum measured;     ///< frame of the compositor - truth
  ErrorSum unexplained;  ///< measured - predicted
  ErrorSum elsewhere;    ///< measured where nothing (less than kNothing) is predicted
  double largest_bound = 0, largest_share_of_bound = 0;  ///< of rounding; ≤ 1: within it everywhere
  std::int64_t beyond_bound = 0;  ///< values whose unexplained error is larger than their rounding bound
  void add(const FramePrediction& prediction, const chunker::Frame& shown);
  PredictionCheck& operator+=(const PredictionCheck& o);
};
/// What single precision leaves of an error that is zero.
inline constexpr double kNothing = 1e-5;

/// One base with its shade layers, as if it alone were factored.
struct FactoredLayer {
  std::string name;
  int shade_layers = 0;
  int frames_shown = 0;   ///< of those compared; merged layers are not shown
  PredictionCheck check;  ///< over the whole frames in which it was shown
};

/// Values of measured error by predicted error, in cells of 1/kCellsOfWhite.
using ErrorCells = std::map<std::pair<int, int>, std::int64_t>;
inline constexpr int kCellsOfWhite = 8192;

/// What is compared with the truth, in this order.
enum class Picture { OverAlone, ShadeResolution, Placement, Reuse, OnePass, UnfactoredReuse };
inline constexpr std::array kPictures = {Picture::OverAlone, Picture::ShadeResolution,
                                         Picture::Placement, Picture::Reuse,
                                         Picture::OnePass,   Picture::UnfactoredReuse};
const char* name(Picture picture);

/// Against the truth, by sampled frame.
struct PictureLoss {
  Picture picture = Picture::OverAlone;
  std::vector<FrameDiff> frames;
};

/// The frame with the largest predicted error: both pictures, and what is needed for maps.
struct ShownFrame {
  int frame = -1;
  chunker::Frame factored;
  FramePrediction prediction;
};

struct FactoringResult {
  std::vector<FactoredLayer> layers;  ///< in the order of their ids
  PredictionCheck frame;              ///< all of them factored
  ErrorCells cells;                   ///< of the frames
  std::vector<int> sampled;
  std::vector<PictureLoss> losses;  ///< by kPictures
  SettingResult factored, unfactored;
  bool blends_over_time = false;  ///< the unfactored sequence does not, and is judged by a truth of its own
  ShownFrame worst;
};

struct FactoringReport {
  Settings given;  ///< what is not varied is as it is here
  std::string sequence, policy, warp;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  FactoringResult result;
};

}  // namespace talisman::sequences
