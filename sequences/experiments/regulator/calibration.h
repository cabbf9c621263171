// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a fiducial say about the picture? Each one against the image error that it is meant to predict.
///
/// A sample is a layer at a frame f, shown by its own sprite of frame f - a, a = 1, 2, 4, … 32, whatever any
/// policy would think of it. The layer alone is composited twice over mid grey (linear 0.5), the same grey
/// for every layer: *old* is the sprite of f - a, carried by the fitted warp, *fresh* that of f, without one.
///
/// error: e = √(Σ (old - fresh)² / 3n), sRGB code values 0 … 255, over the n pixels that the layer covers by
/// half or more in either picture
///
/// PSNR: 20 log₁₀(255 / e), dB, over the same pixels
///
/// apparent shift: √(2 Σ ΔI² / Σ |∇I|²), px, I the luma: by how much a picture with these gradients, in
/// directions that are evenly spread, would have to be shifted to differ so much; over the pixels that both
/// pictures cover, edges excepted. It takes the contrast of the texture out of the error, and saturates where
/// the shift exceeds the size of the texture's details.
///
/// Both sprites are judged by `assess_sprite`, which is what the regulator sees. Samples whose fit is not
/// usable are left out: the regulator never shows them.
///
/// The table of fiducials is open: a new one is one line.

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "regulator/plan.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/statistics.h"
#include "sequences/files/progress.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// A fiducial as a number that is 0 at rest and grows with the fault.
struct CalibratedFiducial {
  const char* name;                                       ///< in files and columns: "geometric"
  const char* label;                                      ///< of an axis: "geometric fiducial"
  const char* unit;                                       ///< "px", "%"
  double (*value)(const regulator::LayerAssessment& of);  ///< NaN where it was not computed
};
std::span<const CalibratedFiducial> calibrated_fiducials();

struct CalibrationSample {
  int layer = -1, frame = 0, age_frames = 0;
  std::vector<double> fiducials;   ///< one per entry of calibrated_fiducials(); NaN: not computed
  double error = 0;                ///< code values
  double apparent_shift_px = NAN;  ///< NaN where there is no gradient
  int pixels = 0;                  ///< n
};

/// a = 1, 2, 4, 8, 16, 32.
std::vector<int> calibrated_ages();

/// All samples of the given frames, by frame, layer and age. Cost: per frame the renders of up to seven
/// frames, and two composites of each layer and age.
std::vector<CalibrationSample> calibration_samples(const Sequence& sequence, const Settings& settings,
                                                   std::span<const int> frames, ProgressKind progress);

/// Samples whose fiducial lies within a factor of √2 of `center`.
struct CalibrationBin {
  double center = 0;
  int samples = 0;
  double median_error = 0, lower_error = 0, upper_error = 0;  ///< code values; quartiles
  double median_shift_px = 0;
  double psnr_db() const { return median_error > 0 ? 20 * std::log10(255 / median_error) : HUGE_VAL; }
};

struct CalibrationSummary {
  const CalibratedFiducial* fiducial = nullptr;
  int computed = 0;                  ///< samples for which there is a number
  RankCorrelation error;             ///< of fiducial and image error, all layers together
  RankCorrelation shift;             ///< of fiducial and apparent shift
  double median_rho_of_layers = 0;   ///< of fiducial and error inside one layer, median of the layers
  int layers = 0;                    ///< that had enough samples for that
  std::vector<CalibrationBin> bins;  ///< octaves around 1, ascending, with enough samples
};

/// One per entry of calibrated_fiducials().
std::vector<CalibrationSummary> summarize_calibration(std::span<const CalibrationSample> samples);

/// How a layer alone looks: mid grey behind it.
struct LayerPicture {
  int width = 0, height = 0;
  std::vector<float> rgb;             ///< sRGB code values, 3 per pixel
  std::vector<std::uint8_t> covered;  ///< 1 where alpha is at least one half
};

struct LayerDifference {
  double error = 0;
  double apparent_shift_px = NAN;
  int pixels = 0;
};
/// Of the same size (programmer error otherwise). Nothing covered: no error.
LayerDifference difference_of(const LayerPicture& old_one, const LayerPicture& fresh);

}  // namespace talisman::sequences
