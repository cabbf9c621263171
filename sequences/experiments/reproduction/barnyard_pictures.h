// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does one see of triple framing, of interpolation, and of thresholds? [LS97 7.2]
///
/// The paper judged by eye: the most dramatic gain comes when interpolation is turned on, and with thresholds the pictures
/// are nearly indistinguishable. Here: FLIP against `reference`, mean over the frames that sampled_frames.h chooses.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct SeenError {
  std::string name;
  double flip = 0;  ///< 0: identical
};

/// `errors`: held, interpolated, then the thresholds. Interpolated has at most half the error of held.
Finding interpolation_is_seen(const std::vector<SeenError>& errors);
/// The thresholds lie below interpolated triple framing and below a FLIP of 0.05.
Finding thresholds_look_alike(const std::vector<SeenError>& errors);

Item barnyard_pictures();

}  // namespace talisman::sequences
