// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which colour does a texture have under a pixel's footprint?
///
/// A pyramid holds the texture in premultiplied linear light, level 0 at full size and each next level at
/// half of it (rounded down, at least 1) by an area-weighted box, so that sizes that are not powers of two do
/// not drift. Filtering is trilinear:
///
///   λ = log₂ max(|∂(u,v)/∂x|, |∂(u,v)/∂y|)    in texels of level 0
///   levels ⌊λ⌋ and ⌊λ⌋ + 1 are mixed by the fraction of λ
///
/// so no seam shows where the level changes. Magnified textures (λ ≤ 0) cost one bilinear sample instead of
/// two. Coordinates repeat unless the texture says otherwise (layers::Wrap): clamped ones show the outermost
/// texels' centres, mirrored ones turn over at each whole number. Texel (i, j) has its centre at ((i + 0.5) / width, (j + 0.5) / height).

#include <algorithm>
#include <cstdint>
#include <vector>

#include "chunker/float4.h"
#include "layers/power.h"
#include "layers/scene.h"

namespace talisman::chunker {

struct MipLevel {
  int width = 0, height = 0;
  std::vector<Float4> texels;  ///< row by row
  layers::Wrap wrap_u = layers::Wrap::Repeat, wrap_v = layers::Wrap::Repeat;
};

struct Pyramid {
  std::vector<MipLevel> levels;               ///< empty: no texture
  std::vector<std::int32_t> widths, heights;  ///< of the levels, for look-ups in lanes
  bool opaque = true;                         ///< alpha is 1 in every texel of every level
  bool nearest = false, nearest_minified = false, finest = false, one_level = false;  ///< as in Texture
  /// Looked up otherwise than trilinearly.
  bool is_special() const { return nearest || nearest_minified || finest || one_level; }
  bool wraps() const {
    return levels[0].wrap_u != layers::Wrap::Repeat || levels[0].wrap_v != layers::Wrap::Repeat;
  }
  bool empty() const { return levels.empty(); }
  std::int64_t bytes() const;
  /// The mean of the whole texture: what a surface without texture coordinates gets.
  Float4 mean() const { return levels.back().texels[0]; }
};

/// Cost: O(texels). A texture without texels, or with fewer bytes than its size asks for, gives an empty
/// pyramid. `coarser`: with all levels; else the finest alone, and no mean.
Pyramid build_pyramid(const layers::Texture& texture, bool coarser = true);

/// The same of a normal texture, whose bytes are no light: n = 2 · byte / 255 - 1, and its means, which are
/// shorter the more the normals under them differ. Alpha is 1.
Pyramid build_normal_pyramid(const layers::Texture& texture, bool coarser);

/// Largest |u|, |v| that is kept as it is; beyond it float coordinates have lost their fraction anyway.
inline constexpr float kLargestTextureCoordinate = 1e6f;
inline float usable_coordinate(float v) {
  if (!(v == v)) return 0;
  return std::clamp(v, -kLargestTextureCoordinate, kLargestTextureCoordinate);
}

/// ⌊x⌋ for |x| < 2³¹ without a library call.
inline int floor_to_int(float x) {
  const int i = static_cast<int>(x);
  return i - (x < static_cast<float>(i) ? 1 : 0);
}

inline Float4 mix(Float4 a, Float4 b, float t) { return a + (b - a) * splat(t); }

/// Position along one axis: the two texels and the share of the second.
struct Tap {
  int first, second;
  float share;
};

/// A coordinate for a texture that does not repeat: inside 0 … 1.
inline float wrapped(float coordinate, layers::Wrap wrap) {
  if (wrap == layers::Wrap::Clamp) return coordinate > 0 ? (coordinate < 1 ? coordinate : 1.0f) : 0.0f;
  const float half = coordinate * 0.5f;
  const float there_and_back = 2 * (half - static_cast<float>(floor_to_int(half)));
  return there_and_back > 1 ? 2 - there_and_back : there_and_back;
}

/// Neighbours beyond the border are the border itself, for clamped coordinates as for mirrored ones.
inline Tap bordered_tap(float coordinate, int size, layers::Wrap wrap) {
  const float x = wrapped(coordinate, wrap) * static_cast<float>(size) - 0.5f;
  const int below = floor_to_int(x);
  return {std::max(below, 0), std::min(below + 1, size - 1), x - static_cast<float>(below)};
}

inline Tap tap(float coordinate, int size, layers::Wrap wrap = layers::Wrap::Repeat) {
  if (wrap != layers::Wrap::Repeat) return bordered_tap(coordinate, size, wrap);
  const float repeated = coordinate - static_cast<float>(floor_to_int(coordinate));
  const float x = repeated * static_cast<float>(size) - 0.5f;
  const int below = floor_to_int(x);
  const int above = below + 1;
  return {below < 0 ? below + size : below, above >= size ? above - size : above,
          x - static_cast<float>(below)};
}

inline Float4 nearest(const MipLevel& level, float u, float v) {
  const Tap x = tap(u, level.width, level.wrap_u), y = tap(v, level.height, level.wrap_v);
  const int column = x.share < 0.5f ? x.first : x.second, row = y.share < 0.5f ? y.first : y.second;
  return level.texels[static_cast<std::size_t>(row) * level.width + column];
}

inline Float4 bilinear(const MipLevel& level, float u, float v) {
  const Tap x = tap(u, level.width, level.wrap_u), y = tap(v, level.height, level.wrap_v);
  const Float4* upper = level.texels.data() + static_cast<std::size_t>(y.first) * level.width;
  const Float4* lower = level.texels.data() + static_cast<std::size_t>(y.second) * level.width;
  return mix(mix(upper[x.first], upper[x.second], x.share), mix(lower[x.first], lower[x.second], x.share),
             y.share);
}

/// `footprint` = λ as above, squared inside the logarithm: max of the two squared lengths in texels².
inline Float4 trilinear(const Pyramid& pyramid, float u, float v, float footprint) {
  if (!(footprint > 1)) return bilinear(pyramid.levels[0], u, v);
  const float last = static_cast<float>(pyramid.levels.size() - 1);
  const float lambda = std::min(0.5f * layers::coarse_log2(footprint), last);
  const int whole = static_cast<int>(lambda);
  const float share = lambda - static_cast<float>(whole);
  const Float4 fine = bilinear(pyramid.levels[whole], u, v);
  return share > 0 ? mix(fine, bilinear(pyramid.levels[whole + 1], u, v), share) : fine;
}

/// As the texture says: minified where `footprint` > 1, from the levels on either side of λ, or the nearest of them,
/// ⌈λ + ½⌉ - 1. [OpenGL ES 3.0, 3.8.10]
Float4 as_texture_says(const Pyramid& pyramid, float u, float v, float footprint);

/// Screen derivatives of (u, v) in texels of level 0: first two channels.
struct TextureDerivatives {
  Float4 x, y;
};

inline float squared_length2(Float4 v) { return v[0] * v[0] + v[1] * v[1]; }

/// `footprint` of trilinear().
inline float footprint_of(const TextureDerivatives& d) {
  return std::max(squared_length2(d.x), squared_length2(d.y));
}

/// Trilinear samples side by side along the longer derivative, each for an equal part of it:
///
///   N = min(⌈major / max(minor, 1)⌉, max_samples),   λ = log₂(major / N)
///
/// `samples` is increased by N. Derivatives that are not finite count as one isotropic sample.
Float4 anisotropic(const Pyramid& pyramid, float u, float v, const TextureDerivatives& derivatives,
                   int max_samples, int& samples);

}  // namespace talisman::chunker
