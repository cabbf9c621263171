// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp leaves the fewest chunks to be drawn? What is drawn anew need not be carried, so the best warp of all points
/// is not the best one: it is that of the most chunks that move alike. Each chunk is one place, near or far. From several
/// beginnings (all of them; the upper, middle, lower, left and right parts of the sprite; the chunks of its first
/// instant) a warp is fitted, and again to the places within 4, 2, 1, 0.7 δ of it.

#include <vector>

#include "regulator/chunk_refresh.h"

namespace talisman::regulator {

/// What stands for a chunk: the middle of content that it shows.
struct ChunkPlace {
  int chunk = -1;
  bool is_first = false;  ///< of the sprite's first instant
  layers::dvec2 then_px{0, 0}, now_px{0, 0};
};

/// The warp keeps fronts fronts, and can be undone and drawn through.
bool is_sound(const warp::FitResult& fitted);

struct ChunkWarp {
  warp::FitResult fitted;  ///< that of all places where none is sound
  int off = 0;             ///< places that it leaves farther off than δ: no fewer chunks are over
};
/// Cost: O(places).
ChunkWarp chunk_warp(const std::vector<ChunkPlace>& places, layers::ivec2 count, const ChunkLimits& limits);

}  // namespace talisman::regulator
