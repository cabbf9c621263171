// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What both readers of models hold to.

#include <numbers>

namespace talisman::sequences {

/// Of the node tree; deeper ones are taken for damage.
inline constexpr int kMaxNodeDepth = 1000;
/// Phong exponent; what would be sharper is not told apart.
inline constexpr float kMaxShininess = 1024;
/// Half the angle of a spot light: a half-space.
inline constexpr double kWidestCone_rad = std::numbers::pi / 2;

}  // namespace talisman::sequences
