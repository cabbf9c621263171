// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The 8×8 transform of compressed chunks, in integers.
///
///   F = T f Tᵀ,  f = Tᵀ F T,   T[k][n] = c_k cos((2n + 1) k π/16),  c_0 = √(1/8), c_k = 1/2
///
/// with T in 12-bit fixed point, and F in quarters. There and back is off by at most one for |f| ≤ 255.
/// Neither direction overflows for any input within its stated range.

#include <array>

namespace talisman::chunker {

inline constexpr int kBlockSide = 8;
inline constexpr int kBlockTexels = kBlockSide * kBlockSide;
/// Row by row.
using Block = std::array<int, kBlockTexels>;

inline constexpr int kLargestCoefficient = 16383;  ///< quarters

/// |f| ≤ 511, so its transform stays within kLargestCoefficient but for rounding.
Block forward_transform(const Block& f);
/// Of coefficients of at most kLargestCoefficient.
Block inverse_transform(const Block& coefficients);

/// Place of the i-th coefficient on the way from low to high frequencies.
const std::array<int, kBlockTexels>& zig_zag();

/// Luma and two chroma channels, exactly reversible. For bytes y is 0 … 255, co and cg -255 … 255.
struct YCoCg {
  int y = 0, co = 0, cg = 0;
};
struct Rgb {
  int r = 0, g = 0, b = 0;
};
inline YCoCg ycocg_from(Rgb c) {
  const int co = c.r - c.b, t = c.b + (co >> 1), cg = c.g - t;
  return {t + (cg >> 1), co, cg};
}
inline Rgb rgb_from(YCoCg c) {
  const int t = c.y - (c.cg >> 1), b = t - (c.co >> 1);
  return {b + c.co, c.cg + t, b};
}

}  // namespace talisman::chunker
