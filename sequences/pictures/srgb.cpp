// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/srgb.h"

#include <algorithm>
#include <cmath>

#include "chunker/pixel.h"

namespace talisman::sequences {

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t srgb_byte(float linear) {
  const float scaled = std::clamp(linear, 0.0f, 1.0f) * static_cast<float>(chunker::kOne);
  return chunker::srgb_from_linear16(static_cast<std::uint16_t>(scaled + 0.5f));
}

float brightness(const layers::vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace talisman::sequences
