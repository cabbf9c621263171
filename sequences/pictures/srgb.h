// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Colours between files, which hold sRGB, and the renderer, which works in linear light.

#include <cstdint>

#include "layers/scene.h"

namespace talisman::sequences {

/// Relative luminance, ITU-R BT.709.
float brightness(const layers::vec3& linear);

/// One component of an sRGB colour (0 … 1) in linear light, IEC 61966-2-1, and back to a byte (clamped).
float linear_from_srgb(float srgb);
std::uint8_t srgb_byte(float linear);

}  // namespace talisman::sequences
