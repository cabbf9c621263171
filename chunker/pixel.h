// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The pixel formats of the pixel side, all in one place.
///
/// Working space: linear light, premultiplied alpha. A sprite texel is four bytes: RGB holds the square root
/// of the premultiplied linear value, A holds linear alpha. Decoding is one multiply per channel and 8 bits
/// do not band in the dark:
///
///   linear16(rgb byte v) = v · v            (0 … 65025 = kOne)
///   linear16(alpha byte a) = a · 255        (0 … 65025)
///
/// The compositor filters and composites in that 16-bit linear space, where 65025 is one. sRGB is applied
/// only to the finished frame.

#include <cmath>
#include <cstdint>

namespace talisman::chunker {

inline constexpr int kChunkSize = 32;         ///< texels, each side [LS97 1.1]
inline constexpr int kBandLines = 32;         ///< display lines that the compositor finishes at a time
inline constexpr std::uint32_t kOne = 65025;  ///< 1.0 in 16-bit linear

/// One sprite texel; see above. Clear is all zero.
struct Texel {
  std::uint8_t r = 0, g = 0, b = 0, a = 0;
  bool operator==(const Texel&) const = default;
};

/// Premultiplied linear colour in floating point, 0 … 1 (colour may exceed alpha for additive layers, never 1
/// after encoding).
struct LinearColor {
  float r = 0, g = 0, b = 0, a = 0;
};

/// Premultiplied linear, 16 bit, kOne = 1.0.
struct Linear16 {
  std::uint16_t r = 0, g = 0, b = 0, a = 0;
  bool operator==(const Linear16&) const = default;
};

inline std::uint8_t encode_sqrt(float linear) {
  const float clamped = linear > 0 ? (linear < 1 ? linear : 1.0f) : 0.0f;  // NaN becomes 0
  return static_cast<std::uint8_t>(std::sqrt(clamped) * 255.0f + 0.5f);
}
inline std::uint8_t encode_alpha(float linear) {
  const float clamped = linear > 0 ? (linear < 1 ? linear : 1.0f) : 0.0f;
  return static_cast<std::uint8_t>(clamped * 255.0f + 0.5f);
}
inline Texel encode(const LinearColor& c) {
  return {encode_sqrt(c.r), encode_sqrt(c.g), encode_sqrt(c.b), encode_alpha(c.a)};
}
inline Linear16 decode(Texel t) {
  return {static_cast<std::uint16_t>(t.r * t.r), static_cast<std::uint16_t>(t.g * t.g),
          static_cast<std::uint16_t>(t.b * t.b), static_cast<std::uint16_t>(t.a * 255)};
}

/// sRGB transfer of one byte to linear 0 … 1, and of 16-bit linear (0 … kOne) to one byte. Exact to rounding.
float linear_from_srgb(std::uint8_t v);
std::uint8_t srgb_from_linear16(std::uint16_t v);

}  // namespace talisman::chunker
