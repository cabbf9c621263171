// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which colour multiplier carries the shading of the old picture to that of the new one? [LS97 4.3]
///
///   for each channel   minimise Σᵢ (m Ĉᵢ - Cᵢ)²      so      m = Σ Ĉᵢ Cᵢ / Σ Ĉᵢ²
///
/// Ĉ and C are the shaded colours, linear light, of the characteristic points at the last render and now. The
/// compositor multiplies each texel of the sprite by (m_r, m_g, m_b). What a multiplier cannot do is bring
/// light to a channel that was black: there it stays 1 and the error says what is missing.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "layers/geometry2.h"

namespace talisman::warp {

enum class ColorStatus : std::uint8_t {
  Converged,  ///< the least-squares multiplier
  Limited,    ///< it would have been above ColorOptions::largest_multiplier; that limit is used
  Black,      ///< the channel was black at every point, or there are no points: 1 is used
  NotFinite,  ///< a colour is NaN, infinite or negative: 1 is used, the errors are kHugePx
};
std::string_view name(ColorStatus status);

struct ColorOptions {
  double largest_multiplier =
      16;  ///< > 0, no unit; more brightens darker sprites, and their quantisation with them
};

struct ColorFit {
  layers::dvec3 multiplier{1, 1, 1};    ///< ≥ 0
  std::array<ColorStatus, 3> status{};  ///< per channel
  double rms = 0;                       ///< √(Σᵢ ‖m Ĉᵢ - Cᵢ‖² / n), linear light
  double max = 0;        ///< largest ‖m Ĉᵢ - Cᵢ‖: the photometric error after the warp [LS97 5.2]
  int worst_point = -1;  ///< where; -1 without points
};

/// Sizes must agree (programmer error otherwise). Cost: O(n).
ColorFit fit_color(std::span<const layers::dvec3> then_linear, std::span<const layers::dvec3> now_linear,
                   const ColorOptions& options = {});

}  // namespace talisman::warp
