// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the policies that look ahead asked for one frame (draw_instant.h).

#include <cstdint>

namespace talisman::sequences {

struct LookaheadReport {
  std::int64_t judged = 0;     ///< pairs of an instant and a frame: would the one's sprite serve the other?
  std::int64_t evaluated = 0;  ///< of these, by the fiducials: nothing simpler was certain
  bool operator==(const LookaheadReport&) const = default;
};

}  // namespace talisman::sequences
