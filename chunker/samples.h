// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where does a texel look: which of the 4×4 places of its lattice are samples?
///
///   16  all of them
///    4  one in each row and each column:  . x . .
///                                         . . . x
///                                         x . . .
///                                         . . x .
///    1  the place at (3/8, 3/8)
///
/// A mask has one bit per sample. Coverage, depth and resolve work on the samples there are, so that fewer
/// cost less; for a full mask their mean position is the texel's centre, but for the single one, which stands
/// for the whole texel and is shaded at its centre as well.

#include <array>
#include <cstdint>
#include <type_traits>

#include "layers/check.h"

namespace talisman::chunker {

inline constexpr int kPlaces = 16;  ///< of a texel's lattice; place 4j + i lies at ((2i + 1)/8, (2j + 1)/8)

template <int kCount>
struct Samples {
  static_assert(kCount == 1 || kCount == 4 || kCount == 16);
  static constexpr std::uint16_t kFull = static_cast<std::uint16_t>((1u << kCount) - 1);
  static constexpr int place(int sample) {
    constexpr std::array<int, 4> kOfFour{1, 7, 8, 14};
    return kCount == 16 ? sample : (kCount == 4 ? kOfFour[sample & 3] : 5);
  }
};

/// `work(std::integral_constant<int, samples>())` for 1, 4 or 16 samples.
template <typename Work>
auto with_samples(int samples, const Work& work) {
  TALISMAN_CHECK(samples == 1 || samples == 4 || samples == 16);
  if (samples == 1) return work(std::integral_constant<int, 1>());
  if (samples == 4) return work(std::integral_constant<int, 4>());
  return work(std::integral_constant<int, 16>());
}

/// Mean position of the samples of a mask, in texels from the texel's corner; (0.5, 0.5) for a full mask.
/// Attributes are evaluated here, so that partly covered texels never take colours from outside the triangle.
struct Centroid {
  float x, y;
};

/// Places lie at odd eighths, 1, 3, 5, 7. Per byte of a mask of 16 (two rows): their number, and the sums of
/// their x and y.
struct ByteSums {
  std::uint8_t count = 0, x = 0, y = 0;
};

inline constexpr std::array<ByteSums, 256> kByteSums = [] {
  std::array<ByteSums, 256> table{};
  for (int byte = 0; byte < 256; ++byte)
    for (int s = 0; s < 8; ++s)
      if (byte >> s & 1) {
        ++table[byte].count;
        table[byte].x = static_cast<std::uint8_t>(table[byte].x + 2 * (s & 3) + 1);
        table[byte].y = static_cast<std::uint8_t>(table[byte].y + 2 * (s >> 2) + 1);
      }
  return table;
}();

/// By mask of four samples; nothing for the empty one.
inline constexpr std::array<Centroid, 16> kCentroidsOfFour = [] {
  std::array<Centroid, 16> table{};
  for (int mask = 1; mask < 16; ++mask) {
    int count = 0, x = 0, y = 0;
    for (int s = 0; s < 4; ++s)
      if (mask >> s & 1) {
        ++count;
        x += 2 * (Samples<4>::place(s) & 3) + 1;
        y += 2 * (Samples<4>::place(s) >> 2) + 1;
      }
    const float r = 0.125f / static_cast<float>(count);
    table[mask] = {static_cast<float>(x) * r, static_cast<float>(y) * r};
  }
  return table;
}();

template <int kCount>
Centroid centroid_of(std::uint16_t mask) {
  if constexpr (kCount == 1) return {0.5f, 0.5f};
  if constexpr (kCount == 4) return kCentroidsOfFour[mask & Samples<4>::kFull];
  const ByteSums &upper = kByteSums[mask & 0xff], &lower = kByteSums[mask >> 8];
  const float r = 0.125f / static_cast<float>(upper.count + lower.count);
  // The lower two rows lie four eighths further down.
  return {static_cast<float>(upper.x + lower.x) * r,
          static_cast<float>(upper.y + lower.y + 4 * lower.count) * r};
}

}  // namespace talisman::chunker
