// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sprites, maps and comparisons that the compositor's tests share.

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "chunker/reference.h"

namespace talisman::chunker {

using layers::dmat3;
using layers::ivec2;

inline std::string to_string(const Linear16& p) {
  std::ostringstream out;
  out << '(' << p.r << ' ' << p.g << ' ' << p.b << ' ' << p.a << ')';
  return out.str();
}

/// A sprite whose texel (x, y) is texel_at(x, y).
inline Sprite make_sprite(ivec2 size, const std::function<Texel(int, int)>& texel_at) {
  Sprite sprite(size);
  for (int row = 0; row < sprite.chunks().y; ++row) {
    for (int column = 0; column < sprite.chunks().x; ++column) {
      Chunk chunk;
      for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
        const int x = column * kChunkSize + i % kChunkSize, y = row * kChunkSize + i / kChunkSize;
        if (x < size.x && y < size.y) chunk.texels[i] = texel_at(x, y);
      }
      sprite.store(column, row, chunk);
    }
  }
  return sprite;
}

inline Sprite solid(ivec2 size, Texel t) {
  return make_sprite(size, [=](int, int) { return t; });
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double real(double lo, double hi) { return lo + (hi - lo) * (engine_() >> 11) * 0x1p-53; }
  int integer(int lo, int hi) {
    return lo + static_cast<int>(engine_() % static_cast<std::uint64_t>(hi - lo + 1));
  }
  bool chance(double p) { return real(0, 1) < p; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(engine_()); }

  /// Clear, opaque, translucent and additive chunks in one sprite.
  Sprite sprite(int max_side) {
    const ivec2 size{integer(0, max_side), integer(0, max_side)};
    std::vector<int> kinds(16);
    for (int& kind : kinds) kind = integer(0, 3);
    return make_sprite(size, [&](int x, int y) -> Texel {
      const int kind = kinds[(x / kChunkSize % 4) * 4 + y / kChunkSize % 4];
      if (kind == 0) return {};
      const std::uint8_t alphas[] = {0, 255, byte(), 0};
      return {byte(), byte(), byte(), alphas[kind]};
    });
  }

 private:
  std::mt19937_64 engine_;
};

inline dmat3 affine(double a, double b, double tx, double c, double d, double ty) {
  return layers::to_mat3({a, b, tx, c, d, ty});
}
inline dmat3 translation(double x, double y) { return affine(1, 0, x, 0, 1, y); }

inline PlacedSprite placed(const Sprite& sprite, const dmat3& map) {
  PlacedSprite p;
  p.sprite = &sprite;
  p.screen_from_sprite = map;
  return p;
}

/// What the hardware would have done. pixels_hidden is what this program left out, and depends on how a stack
/// is cut into calls.
inline CompositeCounters of_the_model(CompositeCounters counters) {
  counters.pixels_hidden = 0;
  return counters;
}

/// The first pixel in which two frames differ, or nothing.
inline std::string difference(const Frame& a, const Frame& b) {
  std::ostringstream out;
  if (a.width != b.width || a.height != b.height || a.pixels.size() != b.pixels.size()) return "sizes differ";
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (a.pixels[i] == b.pixels[i]) continue;
    out << "pixel (" << i % a.width << ", " << i / a.width << "): " << to_string(a.pixels[i]) << " against "
        << to_string(b.pixels[i]);
    return out.str();
  }
  return {};
}

}  // namespace talisman::chunker
