// SPDX-License-Identifier: Apache-2.0
#pragma once

/// At which thresholds would the layer have been kept in this frame, or drawn? And is that so?
///
/// Of a layer that was drawn since fiducials were beyond their limits: the limits from which on it would have been kept, all
/// else, and all frames before, as they were. Of one that was kept: the geometric limit below which it would have been
/// drawn. Both are proved by planning the frame once more, with the limits 1 % above and 1 % below.

#include <string>
#include <vector>

#include "sequences/results/decision_history.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

/// A limit of Thresholds at which the decision changes.
struct FlipLimit {
  std::string name;  ///< as the settings have it: "geometric_px"
  double at = 0;
};

struct FlipThreshold {
  bool was_drawn = false;  ///< in the frame as it was planned
  std::vector<FlipLimit>
      limits;  ///< all of them together; empty: no threshold decides about this layer in this frame
  bool is_proved = false;  ///< 1 % to one side it is kept, to the other (each limit by itself) it is drawn
};

/// `layer`: its history with the line of the frame.
FlipThreshold flip_threshold_of(const Sequence& sequence, const Settings& settings,
                                const LayerHistory& layer);

/// "kept from geometric_px 4.712 on (planned: kept at 1 % more, drawn at 1 % less)"; why there is none, else.
std::string text_of(const FlipThreshold& flip);

}  // namespace talisman::sequences
