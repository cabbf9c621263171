// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The thresholds at which reuses of scenes drawn by lot are audited.
///
/// They were set by hand before those scenes were drawn, not read off: a threshold was wanted at which, on the shipped
/// sequences alone, 99 % of all reuses are displaced by no more than geometric_px + 0.5 px and have 32 dB or more
/// on the layer's own pixels, and none of these has it. AuditRandom.CalibrationByShippedSequences prints the table
/// (every second reuse in the first 60 frames of carousel, stage and canyon):
///
///   geometric_px  photometric   audited   displaced   below 32 dB   together
///       0.25         0.02          218        11            2         6.0 %
///       0.25         0.05          222        17            2         8.6 %
///       0.5          0.02          321         8            8         5.0 %
///       0.5          0.05          325        16            8         7.4 %
///       1            0.02          447         8           52        13.4 %
///       1            0.05          464        17           52        14.9 %
///       2            0.02          573         6          154        27.9 %
///       2            0.05          611        15          165        29.5 %

namespace talisman::tests {

struct Calibration {
  double geometric_px = 0.5;
  double photometric = 0.02;
};
inline constexpr Calibration kCalibration;
inline constexpr double kLeastPsnr_db = 32;

}  // namespace talisman::tests
