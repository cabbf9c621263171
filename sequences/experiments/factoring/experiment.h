// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does it cost that the compositor has only `over`, what do coarse shade layers cost, and what old
/// ones? And what does factoring save?
///
/// The truth of a frame is unfactored: the terms of every layer that has shade layers are drawn in passes of
/// their own and multiplied and added before anything is rounded (chunker/multipass.h), texel on pixel; all
/// layers are composited in exact arithmetic in the order of `reference`. Layers that factor nothing, and
/// those that are merged in a cycle (they are drawn in one pass), are their own truth. Against it, frame by
/// frame, each with one thing more:
///
///   over alone          every layer in every frame, all sprites at full resolution, texel on pixel
///   + shade resolution  shade layers at the sequence's own resolutions
///   + placement         all sprites where and as dense as the sequence has them: rotated, blurred by motion,
///                       compressed, coarser where their authors say so
///   + reuse             the sequence's own policy
///
/// and, for comparison, the same layers unfactored in one pass of the renderer, fresh and under the
/// sequence's policy. One pass gives each of a texel's 16 samples its own shadow, several passes multiply
/// means: where a texel is mixed they differ, and neither is wrong. All of it with the compositor that has
/// `over` alone, whatever the sequence says.
///
/// The loss of `over alone` is predicted (factoring_model.h), of the frame and of each layer as if it alone
/// were factored, and compared with what the compositor made.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sequences/experiments/factoring/prediction.h"
#include "sequences/experiments/factoring/variants.h"
#include "sequences/experiments/regulator/experiment.h"
#include "sequences/files/image_io.h"

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

/// The layers of `report`, which was drawn of `flush` (texel_on_pixel, full resolution) with `state` after
/// it, and their truth from `whole` (the same, unfactored). `constant_blend`: textures are blended as
/// materials say, as the unfactored sequence has them. Sprites of layers that factor nothing stay in `state`.
std::vector<ShadedLayer> shaded_layers(const Pipeline& flush, const Pipeline& whole,
                                       const PipelineState& state, const FrameReport& report,
                                       const chunker::PreparedScene& prepared, bool constant_blend);

/// `variant` must be factored. Cost: each sampled frame about ten renderings and as many comparisons.
FactoringResult measure_factoring(const Variant& variant, const ExperimentFrames& frames,
                                  ProgressKind progress);

}  // namespace talisman::sequences
