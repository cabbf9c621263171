// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which texels does a whole display tile read?
///
/// A tile every pixel of which touches the sprite needs no test per line, and may hide what lies below it.
/// Four corner pixels decide. Affine: the position of a pixel, with all its roundings, never falls (or never
/// rises) along a line and from line to line, because rounding keeps order; so the corners bound all
/// positions exactly. Perspective with a positive denominator at the corners maps the tile into the hull of
/// its corners; with an error of the positions below 1/64 texel their texels are known to within one.

#include <algorithm>
#include <cstdint>
#include <optional>

#include "chunker/sampling.h"

namespace talisman::chunker {

/// Half-open bounds of the first texels of footprints.
struct TapBounds {
  layers::RectI rect{1 << 30, 1 << 30, -(1 << 30), -(1 << 30)};
  void include(int x, int y) {
    rect = {std::min(rect.x0, x), std::min(rect.y0, y), std::max(rect.x1, x + 1), std::max(rect.y1, y + 1)};
  }
  /// All texels of those footprints.
  layers::RectI texels() const { return {rect.x0, rect.y0, rect.x1 + 1, rect.y1 + 1}; }
};

/// Footprints of a tile: they reach at least all sides of `inner` and nothing outside `outer`. The same when
/// affine.
struct TileReach {
  TapBounds inner, outer;
};

/// The reach of the display pixels `pixels` (at least one, at most kRunPixels wide, x0 at the start of a run)
/// if it is certain that each of them touches a sprite of `size`; empty otherwise.
std::optional<TileReach> whole_tile_reach(const TapMap& map, layers::ivec2 size, const layers::RectI& pixels);

}  // namespace talisman::chunker
