// SPDX-License-Identifier: Apache-2.0
#pragma once

/// At which thresholds is a sprite that is reused as good as a fresh one?
///
/// Read off the shipped sequences alone (AuditRandom.CalibrationByShippedSequences prints the table), and
/// frozen here before any scene is drawn by lot: the largest thresholds of the table at which of all reuses 99 %
/// are displaced by no more than geometric_px + 0.5 px and have 32 dB or more on the layer's own pixels.

namespace talisman::tests {

struct Calibration {
  double geometric_px = 0.5;
  double photometric = 0.02;
};
inline constexpr Calibration kCalibration;
inline constexpr double kLeastPsnr_db = 32;

}  // namespace talisman::tests
