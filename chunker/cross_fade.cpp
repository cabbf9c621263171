// SPDX-License-Identifier: Apache-2.0
#include "chunker/cross_fade.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"

namespace talisman::chunker {

namespace {

using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::ivec2;

/// What 16 bits hold as 0 … 1.
LinearColor linear_of(Texel texel) {
  const Linear16 v = decode(texel);
  constexpr float kScale = 1.0f / kOne;
  return {v.r * kScale, v.g * kScale, v.b * kScale, v.a * kScale};
}

/// sum += weight · multiplier · color
void add(LinearColor& sum, const LinearColor& color, float weight, const layers::vec3& multiplier) {
  sum.r += weight * multiplier.x * color.r;
  sum.g += weight * multiplier.y * color.g;
  sum.b += weight * multiplier.z * color.b;
  sum.a += weight * color.a;
}

/// Does bilinear filtering at `at` reach a texel of the sprite?
bool reaches(ivec2 size_px, const dvec2& at) {
  return at.x > -0.5 && at.y > -0.5 && at.x < size_px.x + 0.5 && at.y < size_px.y + 0.5;  // false for NaN
}

void add_bilinear(LinearColor& sum, const FadedSprite& faded, const dvec2& at, double share) {
  if (!reaches(faded.sprite.size_px(), at)) return;
  const dvec2 corner = glm::floor(at - 0.5);
  const dvec2 f = at - 0.5 - corner;
  const ivec2 first(corner);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * share;
      if (weight > 0)
        add(sum, linear_of(faded.sprite.texel(first.x + i, first.y + j)), static_cast<float>(weight),
            faded.color_multiplier);
    }
}

/// The colours of premultiplied layers may exceed alpha (shade layers add light), but not one.
Texel mixed_texel(const FadedSprite& old, const FadedSprite& fresh, const dmat3& old_from_fresh, double share,
                  ivec2 texel) {
  LinearColor sum;
  add(sum, linear_of(fresh.sprite.texel(texel.x, texel.y)), static_cast<float>(share),
      fresh.color_multiplier);
  const dvec3 q = old_from_fresh * dvec3(dvec2(texel) + 0.5, 1);
  if (q.z > 0) add_bilinear(sum, old, dvec2(q) / q.z, 1 - share);
  return encode(sum);
}

}  // namespace

Sprite cross_fade(const FadedSprite& old, const FadedSprite& fresh, const dmat3& old_from_fresh,
                  double share) {
  TALISMAN_CHECK(share >= 0 && share <= 1);
  const ivec2 size = fresh.sprite.size_px();
  Sprite mixed(size);
  const ivec2 chunks = fresh.sprite.chunks();
  for (int row = 0; row < chunks.y; ++row)
    for (int column = 0; column < chunks.x; ++column) {
      Chunk chunk{};
      const ivec2 lo{column * kChunkSize, row * kChunkSize};
      const ivec2 hi = glm::min(lo + kChunkSize, size);
      for (int y = lo.y; y < hi.y; ++y)
        for (int x = lo.x; x < hi.x; ++x)
          chunk.texels[(y - lo.y) * kChunkSize + x - lo.x] =
              mixed_texel(old, fresh, old_from_fresh, share, {x, y});
      mixed.store(column, row, chunk);
    }
  return mixed;
}

}  // namespace talisman::chunker
