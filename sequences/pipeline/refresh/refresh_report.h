// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What drawing chunks alone made of a frame (sequences/pipeline/refresh/refresh.h).

#include <cstdint>

namespace talisman::sequences {

struct RefreshReport {
  int layers = 0;           ///< some of whose chunks are drawn
  std::int64_t chunks = 0;  ///< of them
  double step_px = 0;       ///< the largest between neighbours of different age that are shown
  int torn_borders =
      0;  ///< groups of triangles whose pictures on two sides of a border lie more than δ apart
};

}  // namespace talisman::sequences
