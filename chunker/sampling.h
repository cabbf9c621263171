// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where does a display pixel sample a sprite?
///
/// The centre (sx, sy) of a display pixel goes through the inverse of `screen_from_sprite` to a sprite point
/// (qx, qy). Texel centres lie at +0.5, so the bilinear footprint of the pixel starts at the texel ⌊qx - ½⌋,
/// ⌊qy - ½⌋, and the fraction is the weight of the next texel. The half texel is folded into the map:
///
///   tap_from_screen = [1 0 -½; 0 1 -½; 0 0 1] · screen_from_sprite⁻¹
///
/// Affine: the position is taken in double at the first pixel of each aligned run of kRunPixels display
/// pixels, and stepped from there in 16.16 fixed point. Rounding the start and the step costs at most (1 +
/// 31) · 2⁻¹⁷ < 0.00025 texel, a sixteenth of a weight's step (1/256). Because runs are aligned to the
/// display, the bytes do not depend on where a span starts. Perspective: the position is divided out in
/// double for every pixel; pixels whose denominator is not positive show nothing. Both then round to nearest
/// 1/256 texel, the resolution of the weights.

#include <cmath>
#include <cstdint>
#include <optional>

#include "chunker/pixel.h"
#include "layers/geometry2.h"

namespace talisman::chunker {

inline constexpr int kRunPixels = 32;  ///< display pixels between two positions taken in double

/// Sides of sprites that can be composited, texels: positions are 16.16.
inline constexpr int kMaxSpriteSide = 32766;

/// A footprint's first texel and weight in 16.16, rounded so that bits 16… are the texel and bits 8…15 the
/// weight.
struct TapPosition {
  std::int64_t x = 0, y = 0;
  bool operator==(const TapPosition&) const = default;
};

inline int tap_texel(std::int64_t position) { return static_cast<int>(position >> 16); }
inline int tap_weight(std::int64_t position) { return static_cast<int>((position >> 8) & 255); }

/// Does the footprint weigh any of the texels 0 … size-1?   -1 + 1/256 ≤ position < size
inline bool touches(std::int64_t position, int size) {
  return position >= -65280 && position < (static_cast<std::int64_t>(size) << 16);
}
inline bool touches(TapPosition p, layers::ivec2 size) {
  return touches(p.x, size.x) && touches(p.y, size.y);
}

/// tap_from_screen by rows, for display points (sx, sy, 1).
struct TapMap {
  layers::dvec3 x, y, w{0, 0, 1};
  bool perspective = false;
  std::int64_t step_x = 0, step_y = 0;  ///< 16.16 per display pixel to the right; affine only
};

/// Empty when nothing can be shown: not finite, singular, or minified more than 2³⁰-fold.
std::optional<TapMap> tap_map(const layers::dmat3& screen_from_sprite);

/// ⌊v⌋ for |v| < 2⁶³, without the call that std::floor is on older instruction sets.
inline std::int64_t floor_to_int(double v) {
  const auto truncated = static_cast<std::int64_t>(v);
  return truncated - (v < static_cast<double>(truncated));
}

inline std::int64_t fixed16(double v) { return floor_to_int(v * 65536 + 0.5); }

/// row · (x, y, 1), summed in this order.
inline double along(const layers::dvec3& row, double x, double y) { return row.x * x + row.y * y + row.z; }

/// Affine: position at the pixel (run_x, y). Empty when the run is so far away that no pixel of it can touch
/// a sprite.
inline std::optional<TapPosition> run_start(const TapMap& map, int run_x, int y) {
  constexpr double kMaxPosition = 1099511627776.0;  // 2⁴⁰ texels; times 2¹⁶ it is still exact in an int64
  constexpr std::int64_t kHalfWeight = 128;         // rounds to the nearest weight
  const double x_texels = along(map.x, run_x + 0.5, y + 0.5), y_texels = along(map.y, run_x + 0.5, y + 0.5);
  if (!(std::fabs(x_texels) <= kMaxPosition && std::fabs(y_texels) <= kMaxPosition)) return std::nullopt;
  return TapPosition{fixed16(x_texels) + kHalfWeight, fixed16(y_texels) + kHalfWeight};
}

/// Perspective: position at the pixel (x, y), empty when it does not touch a sprite of `size` or its
/// denominator is not positive.
std::optional<TapPosition> perspective_tap(const TapMap& map, int x, int y, layers::ivec2 size);

/// Half-open range of pixels; empty when first ≥ last.
struct PixelRange {
  int first = 0, last = 0;
  bool empty() const { return first >= last; }
  bool operator==(const PixelRange&) const = default;
};

/// A range of display columns 0 … width-1 that contains every pixel of the lines first_line … last_line
/// (inclusive) whose footprint touches a sprite of `size`. Each side of the sprite is a half plane of the
/// display, also under perspective (times the denominator), so that a horizon needs no special case. At most
/// a pixel or so too wide.
PixelRange columns_touched(const TapMap& map, layers::ivec2 size, int width, int first_line, int last_line);

/// The pixels k of a run, 0 ≤ k < count, with touches(start + k · step, size); they are contiguous.
PixelRange pixels_touching(std::int64_t start, std::int64_t step, int size, int count);

}  // namespace talisman::chunker
