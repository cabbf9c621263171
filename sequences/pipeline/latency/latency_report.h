// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far a frame of a late run is off, judged by the true pose (last_warp.h).

#include <vector>

#include "layers/geometry2.h"

namespace talisman::sequences {

struct LatencyReport {
  double drawn_turn_deg = 0;  ///< between the camera that decisions know and the true one
  double shown_turn_deg = 0;  ///< … and that of the last warp; the same where there is none
  double drawn_moved_m = 0, shown_moved_m = 0;  ///< likewise, between their places
  double true_px = 0;                           ///< the largest of all layers
  double true_mean_px = 0;                      ///< mean over the layers that are shown
  int layers_missing = 0;                       ///< that the true camera sees, and the frame does not show
  bool operator==(const LatencyReport&) const = default;
};

/// Beside it: what is not a number of the frame.
struct LateDisplay {
  LatencyReport report;
  std::vector<double> layer_px;      ///< by layer id; negative: not shown, or not judged
  layers::dmat3 whole_picture{1.0};  ///< of a frame without sprites: what the last warp moves it by
};

}  // namespace talisman::sequences
