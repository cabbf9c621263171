// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A display tile of 32×32 pixels under one sprite: which of its pixels touch, where they sample, and which of its lines the
/// sprite hides from all that lies below it.
///
/// A tile is hidden by strips of eight lines: a sprite that is no larger than a few tiles seldom covers all of one, and often
/// a strip of it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "chunker/sampling.h"
#include "chunker/span_composite.h"
#include "chunker/sprite.h"
#include "chunker/tile_reach.h"

namespace talisman::chunker {

inline constexpr int kStripLines = 8, kStrips = kBandLines / kStripLines;

/// A bit for each strip.
using Strips = unsigned;
inline constexpr Strips kAllStrips = (1u << kStrips) - 1;
inline bool has_strip_of(Strips strips, int line) { return (strips >> line / kStripLines & 1u) != 0; }

/// A sprite that shows something, ready for sampling.
struct Visible {
  const Sprite* sprite = nullptr;
  TapMap map;
  Multiplier multiplier;
  PixelRange lines;                      ///< of the display; no others touch it
  std::optional<layers::ivec2> lattice;  ///< where each pixel shows a whole texel: that of pixel (0, 0)
};

/// A display tile and where it lies; the part outside the display is drawn but not kept.
struct Tile {
  int x = 0, y = 0;
  layers::ivec2 display{0, 0};
  PackedPixel* pixels = nullptr;  ///< kBandLines rows of kRunPixels
  int columns() const { return std::min(kRunPixels, display.x - x); }
  int lines() const { return std::min(kBandLines, display.y - y); }
  layers::RectI rect() const { return {x, y, x + columns(), y + lines()}; }
  /// Strip k of kStrips: the lines first … last-1 of the tile, cut at the display; may be empty.
  PixelRange strip(int k) const { return {k * kStripLines, std::min((k + 1) * kStripLines, lines())}; }
};

/// The lines of an affine tile, all but the window that they read from.
struct AffineLines {
  TileJob job;
  std::int64_t pixel_count = 0, line_count = 0;
  TapBounds bounds;
};

AffineLines affine_lines(const Visible& v, const Tile& tile);
/// The lines of `strips` are left out. Returns their pixels that touch.
std::int64_t leave_out(Strips strips, AffineLines& lines);

/// Positions of all pixels of a tile, one by one: perspective, and minified so far that a window does not
/// hold the tile.
struct PixelTaps {
  static constexpr std::int64_t kNothing = INT64_MIN;
  std::array<TapPosition, kBandLines * kRunPixels> at;
  std::int64_t pixel_count = 0, line_count = 0;
  TapBounds bounds;
};

void locate_perspective(const Visible& v, const Tile& tile, PixelTaps& taps);
/// The pixels of an affine tile without a window. Positions of pixels that touch fit 32 bits with their sign.
void locate_minified(const TileJob& job, const Tile& tile, PixelTaps& taps);
std::int64_t leave_out(Strips strips, PixelTaps& taps);

/// Of `asked`: the strips in which each pixel shows opaque texels alone, so that nothing below them is seen. Empty strips
/// count as such.
Strips strips_hidden_by(const Visible& v, const Tile& tile, Strips asked);

}  // namespace talisman::chunker
