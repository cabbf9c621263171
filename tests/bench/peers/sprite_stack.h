// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The compositors' workload, the same texels for us and for our peers.
///
/// 1344×1024; sprites whose rectangles add up to a number of displays; turned by ±5°, scaled by 0.9 … 1.1, or
/// unwarped on the display's lattice; super-elliptic alpha with soft edges that end inside the rectangle, every
/// fourth sprite translucent. Peers take the bytes as they are, 8-bit premultiplied; we take them for square
/// roots of linear light and composite in 16-bit linear. So each has an oracle of its own arithmetic.

#include <cstdint>
#include <vector>

#include "chunker/composite.h"
#include "layers/geometry2.h"

namespace talisman::bench {

inline constexpr layers::ivec2 kDisplay{1344, 1024};
inline constexpr std::uint32_t kBackgroundArgb = 0xff404040u;
inline constexpr layers::vec3 kBackground{0.063f, 0.063f, 0.063f};  ///< (0x40 / 255)², linear

/// 8-bit premultiplied, alpha in the highest byte, row by row without gaps.
struct Picture {
  layers::ivec2 size_px{0, 0};
  std::vector<std::uint32_t> argb;
};

struct SpriteStack {
  std::vector<chunker::Sprite> sprites;
  std::vector<Picture> pictures;  ///< the same texels, one for each sprite
  std::vector<layers::Affine2> screen_from_sprite;
  std::vector<chunker::PlacedSprite> placed;
};

/// `count` ≥ 1 sprites, `displays` ≥ 1.
SpriteStack make_sprite_stack(int count, int displays, bool unwarped);

/// Where sprite `i` can show on the display.
layers::RectI bounds_px(const SpriteStack& stack, std::size_t i);

/// The stack in double precision over the background, rounded once: what every 8-bit compositor approximates.
/// Four bytes a pixel, those of Picture in the order of memory.
std::vector<unsigned char> exact_composite(const SpriteStack& stack);

/// A peer's picture in the same form.
std::vector<unsigned char> bytes_of(const std::vector<std::uint32_t>& argb);

}  // namespace talisman::bench
