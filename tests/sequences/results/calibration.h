// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The thresholds at which reuses of scenes drawn by lot are audited.
///
/// Read off the shipped sequences alone, before the scenes of that audit were drawn: of the pairs below the loosest at
/// which 99 % of all reuses are displaced by no more than geometric_px + 0.5 px and have 32 dB or more on the
/// layer's own pixels. AuditRandom.CalibrationByShippedSequences prints the table (every second reuse in the first 60
/// frames of carousel, stage and canyon):
///
///   geometric_px  photometric   audited   displaced   below 32 dB   together
///       0.25         0.02          218         0            2         0.9 %
///       0.25         0.05          222         0            2         0.9 %
///       0.5          0.02          321         0            8         2.5 %
///       0.5          0.05          325         0            8         2.5 %
///       1            0.02          447         2           52        12.1 %
///       1            0.05          464         2           52        11.6 %
///       2            0.02          571         1          154        27.2 %

namespace talisman::tests {

struct Calibration {
  double geometric_px = 0.25;
  double photometric = 0.05;
};
inline constexpr Calibration kCalibration;
inline constexpr double kLeastPsnr_db = 32;

}  // namespace talisman::tests
