// SPDX-License-Identifier: Apache-2.0
#include "chunker/pixel.h"

#include <array>

namespace talisman::chunker {
namespace {

double linear_from_srgb_exact(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
double srgb_from_linear_exact(double v) {
  return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

std::array<float, 256> make_decode_table() {
  std::array<float, 256> table{};
  for (int v = 0; v < 256; ++v) table[v] = static_cast<float>(linear_from_srgb_exact(v / 255.0));
  return table;
}

/// One byte per 16-bit value, so that a finished frame costs one look-up per channel. Values above kOne stay
/// white.
std::array<std::uint8_t, 65536> make_encode_table() {
  std::array<std::uint8_t, 65536> table{};
  for (std::uint32_t v = 0; v < table.size(); ++v) {
    const double linear = v < kOne ? static_cast<double>(v) / kOne : 1.0;
    table[v] = static_cast<std::uint8_t>(srgb_from_linear_exact(linear) * 255 + 0.5);
  }
  return table;
}

}  // namespace

float linear_from_srgb(std::uint8_t v) {
  static const std::array<float, 256> table = make_decode_table();
  return table[v];
}

std::uint8_t srgb_from_linear16(std::uint16_t v) {
  static const std::array<std::uint8_t, 65536> table = make_encode_table();
  return table[v];
}

}  // namespace talisman::chunker
