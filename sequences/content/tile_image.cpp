// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/tile_image.h"

#include <array>
#include <cmath>

#include "chunker/pixel.h"

namespace talisman::sequences {

TileImage linear_tile(const layers::Texture& texture) {
  std::array<float, 256> table;
  for (int i = 0; i < 256; ++i) table[i] = chunker::linear_from_srgb(static_cast<std::uint8_t>(i));
  TileImage tile{texture.width, texture.height, {}};
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4)
    tile.texels.push_back({table[texture.rgba[i]], table[texture.rgba[i + 1]], table[texture.rgba[i + 2]]});
  return tile;
}

TileImage cover_tile(const layers::Texture& texture) {
  TileImage tile{texture.width, texture.height, {}};
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4)
    tile.texels.push_back(
        layers::vec3(static_cast<float>(texture.rgba[i + (texture.has_alpha ? 3 : 0)]) / 255.0f));
  return tile;
}

layers::vec3 TileImage::operator()(double u, double v) const {
  const double x = (u - std::floor(u)) * width - 0.5, y = (v - std::floor(v)) * height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const auto at = [&](int i, int j) {
    return texels[static_cast<std::size_t>((j + height) % height) * width + (i + width) % width];
  };
  const layers::vec3 top = (1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0);
  const layers::vec3 bottom = (1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1);
  return (1 - fy) * top + fy * bottom;
}

TileImage reduced_tile(TileImage tile, double tile_m, double texel_m) {
  while (tile.width % 2 == 0 && tile.height % 2 == 0 && tile_m / tile.width < 0.75 * texel_m) {
    TileImage half{tile.width / 2, tile.height / 2, {}};
    for (int y = 0; y < half.height; ++y)
      for (int x = 0; x < half.width; ++x) {
        const layers::vec3* above = &tile.texels[static_cast<std::size_t>(2 * y) * tile.width + 2 * x];
        const layers::vec3* below = above + tile.width;
        half.texels.push_back(0.25f * ((above[0] + above[1]) + (below[0] + below[1])));
      }
    tile = std::move(half);
  }
  return tile;
}

}  // namespace talisman::sequences
