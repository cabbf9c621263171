// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sprite that is shown as it was drawn: each display pixel shows one whole texel.
///
/// That is so where the map is a shift by whole texels, up to 2⁻¹⁰ texel on each side: positions (sampling.h) round to weights of 0
/// from 2⁻⁹ on, and what stepping and rounding add to them is below 2⁻²⁸. Then pixel (x, y) shows the texel (x, y) + `origin`, the
/// pixels that touch are a rectangle, and texels are read from their chunks where they lie: no positions, no window, no filter.

#include <optional>

#include "chunker/sampling.h"
#include "chunker/span_composite.h"
#include "chunker/sprite.h"
#include "chunker/tile_reach.h"

namespace talisman::chunker {

/// The texel that display pixel (0, 0) shows or would show; empty where pixels do not show whole texels.
std::optional<layers::ivec2> lattice_origin(const TapMap& map);

/// What a tile shows of such a sprite.
struct LatticeReach {
  layers::RectI pixels;  ///< of the display; may be empty
  std::int64_t pixel_count = 0, line_count = 0;
  TapBounds bounds;  ///< of the footprints' first texels
};
LatticeReach lattice_reach(layers::ivec2 origin, layers::ivec2 size, const layers::RectI& tile);

/// What blend_lattice() needs for the tile at `tile_px`, which shows `pixels` (not empty). Reads the chunks of these, late ones too, and no others.
LatticeJob lattice_job(const Sprite& sprite, layers::ivec2 origin, layers::ivec2 tile_px,
                       const layers::RectI& pixels, const Multiplier& multiplier);

}  // namespace talisman::chunker
