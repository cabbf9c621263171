// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the compositor is told in floating point, as the integers it computes with: round(clamp(v, 0, 1) ·
/// kOne); NaN counts as 0.

#include <algorithm>

#include "chunker/pixel.h"
#include "chunker/span_composite.h"
#include "layers/geometry2.h"

namespace talisman::chunker {

inline std::uint16_t fixed_linear(double v) {
  const double clamped = v > 0 ? std::min(v, 1.0) : 0.0;
  return static_cast<std::uint16_t>(clamped * kOne + 0.5);
}

inline Linear16 fixed_background(layers::vec3 c) {
  return {fixed_linear(c.x), fixed_linear(c.y), fixed_linear(c.z), static_cast<std::uint16_t>(kOne)};
}

/// The alpha multiplier scales all four channels, the colour multiplier the colour only.
inline Multiplier fixed_multiplier(layers::vec3 color, float alpha) {
  const auto clamped = [](float v) { return v > 0 ? std::min(static_cast<double>(v), 1.0) : 0.0; };
  const double a = clamped(alpha);
  return {{fixed_linear(clamped(color.x) * a), fixed_linear(clamped(color.y) * a),
           fixed_linear(clamped(color.z) * a), fixed_linear(a)}};
}

}  // namespace talisman::chunker
