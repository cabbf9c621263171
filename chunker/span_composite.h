// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The inner loop of the compositor: 32 display pixels of one line, sampled bilinearly from a sprite and laid
/// over what is there.
///
///   h  = (left · (256 - wx) + right · wx + 128) >> 8          16-bit linear, of both texel rows
///   S  = (h_top · (256 - wy) + h_bottom · wy + 128) >> 8      8-bit weights, each step rounded to nearest
///   S ← round(S · m / kOne)                                    only when a multiplier is not one
///   C ← min(S + round(C · (kOne - αS) / kOne), kOne)           over; exact rounding division
///
/// Whole-texel positions (wx = wy = 0) reproduce decode(texel) exactly; αS = kOne replaces; αS = 0 adds and
/// saturates. Everything is integer arithmetic, so that every instruction set gives the same bytes. The work
/// is split in three so that each part is what a CPU does well: positions and weights (vector), fetching
/// texel pairs (scalar loads), filter and over (vector).

#include <array>
#include <cstdint>
#include <vector>

#include "chunker/pixel.h"
#include "chunker/sampling.h"

namespace talisman::chunker {

/// The bytes of one Linear16, red lowest.
using PackedPixel = std::uint64_t;

/// Colour and alpha multipliers of a sprite, kOne = 1, in the order of Linear16.
struct Multiplier {
  Linear16 m{kOne, kOne, kOne, kOne};
  bool is_one() const { return m == Linear16{kOne, kOne, kOne, kOne}; }
  bool is_zero() const { return m == Linear16{}; }
};

/// The 2×2 texels under each pixel of a run. Pixels that show nothing have zero texels, and weights that add
/// up to 256 all the same.
struct Footprints {
  alignas(64) std::uint64_t top[kRunPixels];  ///< two texels side by side, left one in the low half
  alignas(64) std::uint64_t bottom[kRunPixels];
  alignas(64) std::uint32_t weight_x[kRunPixels];  ///< (256 - w) | w << 16
  alignas(64) std::uint32_t weight_y[kRunPixels];
};

inline std::uint32_t weight_pair(int w) { return static_cast<std::uint32_t>(256 - w + (w << 16)); }

/// One line of a 32×32 display tile under an affine map.
struct LineJob {
  std::uint32_t x = 0, y = 0;  ///< position at the first pixel of the run, 16.16 modulo 2³²: exact again at
                               ///< the pixels that touch
  PixelRange pixels;           ///< those that touch the sprite; empty: the line is skipped
};

/// An affine tile: its lines, and a window of texels that holds every footprint.
struct TileJob {
  std::array<LineJob, kBandLines> lines;
  std::uint32_t step_x = 0, step_y = 0;
  Multiplier multiplier;
  const Texel* window = nullptr;
  std::uint32_t stride = 0;                  ///< texels per row of the window
  std::uint32_t origin_x = 0, origin_y = 0;  ///< position of the window's first texel, as those of the lines
};

/// A tile that shows whole texels, each pixel one (lattice.h): the four chunks that it reads, and where in them.
struct LatticeJob {
  const Texel* chunks[2][2] = {};  ///< [row][column], each 32×32 texels; null: clear
  int column = 0, row = 0;         ///< 0 … 31: the texel of chunks[0][0] that the tile's first pixel shows
  PixelRange columns, lines;       ///< of the tile's pixels, those that touch the sprite
  Multiplier multiplier;
};

/// Lays it over `tile`, as blend_tile() would.
void blend_lattice(const LatticeJob& job, PackedPixel* tile);

/// Lays a tile's lines over `tile` (kBandLines rows of kRunPixels pixels).
void blend_tile(const TileJob& job, PackedPixel* tile);

/// Lays one run over `destination` (kRunPixels pixels).
void blend_run(const Footprints& footprints, const Multiplier& multiplier, PackedPixel* destination);

/// Instruction sets this machine can run, best first, and a switch to one of them. For tests and
/// measurements; the result never depends on it. `use_instruction_set(0)` returns to the best.
std::vector<std::int64_t> instruction_sets();
const char* instruction_set_name(std::int64_t set);
void use_instruction_set(std::int64_t set);

}  // namespace talisman::chunker
