// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Logarithm and power made of additions and multiplications only.
///
/// The C library picks its own variants of these functions by processor (with and without fused
/// multiply-add), and their last bits differ; sprites and decisions must not.

#include <bit>
#include <cstdint>

namespace talisman::layers {

/// log₂ of a positive normal x, absolute error < 1e-2; monotone and exact at powers of two. Enough to choose
/// a mip level.
inline float coarse_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u) - 1;  // 0 … 1
  return static_cast<float>(static_cast<int>(bits >> 23) - 127) + m + 0.3465f * m * (1 - m);
}

/// log₂ x = e + log₂ m, m in [√½, √2), by 2 artanh((m - 1) / (m + 1)); absolute error < 1e-12.
inline double precise_log2(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  double m = std::bit_cast<double>((bits & 0x000fffffffffffffull) | 0x3ff0000000000000ull);
  int e = static_cast<int>(bits >> 52) - 1023;
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++e;
  }
  const double t = (m - 1) / (m + 1), s = t * t;
  const double series =
      1 + s * (1.0 / 3 + s * (1.0 / 5 + s * (1.0 / 7 + s * (1.0 / 9 + s * (1.0 / 11 + s * (1.0 / 13))))));
  return e + 2.8853900817779268 * t * series;
}

/// 2^y for y ≤ 0, relative error < 1e-9; 0 below 2^-126.
inline double precise_exp2(double y) {
  if (!(y > -126)) return 0;
  const int whole = static_cast<int>(y - 0.5);  // nearest, as y ≤ 0
  const double f = (y - whole) * 0.69314718055994531;
  const double series =
      1 +
      f * (1 + f * (1.0 / 2 +
                    f * (1.0 / 6 + f * (1.0 / 24 + f * (1.0 / 120 + f * (1.0 / 720 + f * (1.0 / 5040)))))));
  return series * std::bit_cast<double>(static_cast<std::uint64_t>(whole + 1023) << 52);
}

/// xʸ for 0 ≤ x ≤ 1 and y ≥ 0: the Phong lobe. x⁰ = 1 for x > 0, and 0ʸ = 0.
inline float power_of_unit(float x, float y) {
  if (!(x > 1e-30f)) return 0;
  if (x >= 1) return 1;
  return static_cast<float>(precise_exp2(y * precise_log2(x)));
}

}  // namespace talisman::layers
