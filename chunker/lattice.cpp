// SPDX-License-Identifier: Apache-2.0
#include "chunker/lattice.h"

#include <algorithm>
#include <cmath>

#include "chunker/window.h"

namespace talisman::chunker {
namespace {

constexpr double kMostShift = 1 << 20;      // texels; beyond it no pixel of a display touches a sprite
constexpr double kOffLattice = 1.0 / 1024;  // texels

/// Of one axis: the texel of pixel 0, whose centre is at ½.
std::optional<int> shift_of(double along_axis, double across, double offset) {
  if (along_axis != 1 || across != 0 || !(std::fabs(offset) < kMostShift)) return std::nullopt;
  const double texel = offset + 0.5, whole = std::nearbyint(texel);
  if (std::fabs(texel - whole) > kOffLattice) return std::nullopt;
  return static_cast<int>(whole);
}

}  // namespace

std::optional<layers::ivec2> lattice_origin(const TapMap& map) {
  if (map.perspective) return std::nullopt;
  const auto x = shift_of(map.x.x, map.x.y, map.x.z), y = shift_of(map.y.y, map.y.x, map.y.z);
  if (!x || !y) return std::nullopt;
  return layers::ivec2(*x, *y);
}

LatticeReach lattice_reach(layers::ivec2 origin, layers::ivec2 size, const layers::RectI& tile) {
  LatticeReach reach;
  reach.pixels = {std::max(tile.x0, -origin.x), std::max(tile.y0, -origin.y),
                  std::min(tile.x1, size.x - origin.x), std::min(tile.y1, size.y - origin.y)};
  if (reach.pixels.empty()) return reach;
  reach.line_count = reach.pixels.height();
  reach.pixel_count = reach.line_count * reach.pixels.width();
  reach.bounds.include(reach.pixels.x0 + origin.x, reach.pixels.y0 + origin.y);
  reach.bounds.include(reach.pixels.x1 - 1 + origin.x, reach.pixels.y1 - 1 + origin.y);
  return reach;
}

LatticeJob lattice_job(const Sprite& sprite, layers::ivec2 origin, layers::ivec2 tile_px,
                       const layers::RectI& pixels, const Multiplier& multiplier) {
  const layers::ivec2 first = tile_px + origin;  // the texel of the tile's first pixel
  LatticeJob job;
  for (int row = chunk_of(pixels.y0 + origin.y); row <= chunk_of(pixels.y1 - 1 + origin.y); ++row)
    for (int column = chunk_of(pixels.x0 + origin.x); column <= chunk_of(pixels.x1 - 1 + origin.x); ++column)
      if (const Chunk* chunk = chunk_or_clear(sprite, column, row))
        job.chunks[row - chunk_of(first.y)][column - chunk_of(first.x)] = chunk->texels;
  job.column = first.x & (kChunkSize - 1);
  job.row = first.y & (kChunkSize - 1);
  job.columns = {pixels.x0 - tile_px.x, pixels.x1 - tile_px.x};
  job.lines = {pixels.y0 - tile_px.y, pixels.y1 - tile_px.y};
  job.multiplier = multiplier;
  return job;
}

}  // namespace talisman::chunker
