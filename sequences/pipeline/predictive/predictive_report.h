// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What policy Predictive did for one frame (plan_buffers.h).

#include <cstdint>

#include "chunker/plan_buffer.h"

namespace talisman::sequences {

struct PredictiveReport {
  int slice_first = 0;                   ///< first frame of the slice
  int slice_frames = 0;                  ///< for which it is planned, N
  int surprises = 0;                     ///< 1: the plan before was dropped in this frame, and all is drawn
  int surprised = 0;                     ///< parts that were not where they were expected
  int parts = 0, parts_drawn = 0;        ///< shown, and drawn for this frame
  int joins_planned = 0;                 ///< of two whole buffers, as regulator::joins_of_slice counts them
  int joins_without_content = 0;         ///< of these: with a node that has no part
  std::int64_t prediction_vertices = 0;  ///< projected for this frame: those of its slice in its first
  std::int64_t buffer_bytes = 0;         ///< when drawn: of all buffers, with depth and part
  /// When drawn with more than one sample for each texel: displayed pixels that are partly covered. A join shows the
  /// background through them where another buffer has something behind (chunker/plan_buffer.h).
  std::int64_t edge_pixels = 0;
  chunker::JoinCounters joined;  ///< when drawn: what was joined for this frame
  bool operator==(const PredictiveReport&) const = default;
};

}  // namespace talisman::sequences
