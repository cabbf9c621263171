// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/shade_ratio.h"

#include <algorithm>
#include <vector>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using chunker::LinearColor;
using chunker::LinearImage;

/// Of what the sprites of both would hold: no more than 1.
float ratio(float part, float whole) {
  return whole > 0 ? std::clamp(std::min(part, 1.0f) / std::min(whole, 1.0f), 0.0f, 1.0f) : 1.0f;
}

/// Texels that are not covered take the mean of their covered neighbours; `otherwise` without any.
void carry_beside(const std::vector<bool>& covered, const LinearColor& otherwise, LinearImage& image) {
  const int width = image.size_px.x, height = image.size_px.y;
  const auto place = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  const std::vector<LinearColor> own = image.texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (covered[place(x, y)]) continue;
      LinearColor sum;
      int count = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          if (!covered[place(u, v)]) continue;
          const LinearColor& c = own[place(u, v)];
          sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b, sum.a + c.a};
          ++count;
        }
      const float n = static_cast<float>(count);
      image.texels[place(x, y)] =
          count > 0 ? LinearColor{sum.r / n, sum.g / n, sum.b / n, sum.a / n} : otherwise;
    }
}

std::vector<bool> covered_texels(const LinearImage& surface) {
  std::vector<bool> covered;
  covered.reserve(surface.texels.size());
  for (const LinearColor& c : surface.texels) covered.push_back(c.a > 0);
  return covered;
}

}  // namespace

LinearImage left_of_light(const LinearImage& seen, const LinearImage& whole) {
  TALISMAN_CHECK(seen.size_px == whole.size_px);
  LinearImage left = whole;
  left.counters += seen.counters;
  for (std::size_t i = 0; i < left.texels.size(); ++i) {
    const LinearColor &v = seen.texels[i], &w = whole.texels[i];
    left.texels[i] = {ratio(v.r, w.r), ratio(v.g, w.g), ratio(v.b, w.b), 1};
  }
  carry_beside(covered_texels(whole), {1, 1, 1, 1}, left);
  return left;
}

LinearImage darkness_atop(const LinearImage& shadow, const LinearImage& surface) {
  TALISMAN_CHECK(shadow.size_px == surface.size_px);
  LinearImage darkness = shadow;
  darkness.counters += surface.counters;
  for (std::size_t i = 0; i < darkness.texels.size(); ++i)
    darkness.texels[i] = {0, 0, 0, 1 - chunker::light_left(shadow.texels[i].a, surface.texels[i].a)};
  carry_beside(covered_texels(surface), {}, darkness);
  return darkness;
}

}  // namespace talisman::sequences
