// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The over-only compositor [LS97 1.1, 3]: warped sprites, back to front, into one frame, 32 lines at a time.
///
///   C ← S + C · (1 - αS)       per channel, premultiplied, 16-bit linear; "+" is over with αS = 0
///
/// For each band only the sprites that touch it are visited; each is sampled bilinearly under its map
/// (perspective divides per pixel), clear chunks are skipped, opaque runs replace. Bands are independent
/// jobs; the bytes do not depend on their order.
///
/// A 32×32 tile starts at the topmost sprite that is opaque in every texel it reads there and has no
/// multiplier: the sprites below cannot show (αS = 1 leaves S), so the bytes are those of the whole stack.
/// They still count as composited, because the hardware that is modelled composites them.

#include <cstdint>
#include <span>
#include <vector>

#include "chunker/sprite.h"
#include "warp/warp.h"

namespace talisman::chunker {

struct PlacedSprite {
  const Sprite* sprite = nullptr;
  layers::dmat3 screen_from_sprite{1.0};   ///< warp ∘ placement; third row (0 0 1) unless perspective
  layers::vec3 color_multiplier{1, 1, 1};  ///< 0 … 1 per channel
  float alpha_multiplier = 1;              ///< 0 … 1, scales all four channels
};

/// A finished picture, 16-bit linear premultiplied over an opaque background (alpha is always kOne).
struct Frame {
  int width = 0, height = 0;
  std::vector<Linear16> pixels;  ///< row by row
  bool operator==(const Frame&) const = default;
};

struct CompositeCounters {
  std::int64_t sprite_bands = 0;          ///< sprite–band pairs visited
  std::int64_t pixels_composited = 0;     ///< display pixels inside sprite rectangles, summed over sprites
  std::int64_t pixels_hidden = 0;         ///< those of them that were not computed: an opaque sprite of the
                                          ///< same call covers their tile. Depends on how a stack is cut
  std::int64_t chunks_skipped_clear = 0;  ///< pixel runs skipped because the sprite is clear there
  CompositeCounters& operator+=(const CompositeCounters& o);
  bool operator==(const CompositeCounters&) const = default;
};

struct CompositeResult {
  Frame frame;
  CompositeCounters counters;
};

/// Sprites back to front over `background` (linear 0 … 1). A map that is singular or not finite shows
/// nothing.
CompositeResult composite(std::span<const PlacedSprite> sprites, layers::ivec2 display_px,
                          layers::vec3 background);

/// The same into `frame`, whose memory is used again when it is large enough: about a tenth faster for a
/// sequence of frames.
CompositeCounters composite_into(Frame& frame, std::span<const PlacedSprite> sprites,
                                 layers::ivec2 display_px, layers::vec3 background);

/// The same over the picture that `frame` already holds, which may be clear or translucent: alpha is
/// composited like the colours. A stack that is composited in parts equals the whole, byte for byte.
CompositeCounters composite_onto(Frame& frame, std::span<const PlacedSprite> sprites);

/// sRGB bytes, 3 per pixel.
std::vector<std::uint8_t> srgb_bytes(const Frame& frame);

}  // namespace talisman::chunker
