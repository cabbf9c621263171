// SPDX-License-Identifier: Apache-2.0
#include "chunker/cross_fade.h"

#include <limits>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

using layers::dmat3;

Sprite of_one_texel(layers::ivec2 size_px, layers::ivec2 at, Texel texel) {
  Sprite sprite(size_px);
  Chunk chunk{};
  chunk.texels[at.y * kChunkSize + at.x] = texel;
  sprite.store(0, 0, chunk);
  return sprite;
}

dmat3 shifted_by(double x, double y) { return {1, 0, 0, 0, 1, 0, x, y, 1}; }

TEST(CrossFade, MixesLightAndCoverageAlike) {
  const Sprite white = of_one_texel({3, 1}, {1, 0}, {255, 255, 255, 255});
  const Sprite clear({3, 1});
  // A quarter of white: 255 · √¼ = 127.5 and 255 · ¼ = 63.75.
  EXPECT_EQ(cross_fade({clear}, {white}, dmat3(1), 0.25).texel(1, 0), (Texel{128, 128, 128, 64}));
  EXPECT_EQ(cross_fade({white}, {clear}, dmat3(1), 0.75).texel(1, 0), (Texel{128, 128, 128, 64}));
  EXPECT_EQ(cross_fade({white}, {clear}, dmat3(1), 0.75).texel(0, 0), Texel{});
}

TEST(CrossFade, OfTheSamePictureIsThatPicture) {
  const Sprite picture = of_one_texel({40, 40}, {7, 9}, {13, 200, 77, 255});
  for (const double share : {0.0, 0.3, 1.0})
    EXPECT_EQ(cross_fade({picture}, {picture}, dmat3(1), share).texel(7, 9), (Texel{13, 200, 77, 255}));
}

TEST(CrossFade, TheOldSpriteLiesWhereTheMapPutsIt) {
  const Sprite old = of_one_texel({4, 4}, {2, 1}, {255, 255, 255, 255});
  const Sprite fresh({4, 4});
  const Sprite mixed = cross_fade({old}, {fresh}, shifted_by(2, 0), 0);
  EXPECT_EQ(mixed.texel(0, 1), (Texel{255, 255, 255, 255}));
  EXPECT_EQ(mixed.texel(2, 1), Texel{});
  const Sprite between = cross_fade({old}, {fresh}, shifted_by(0.5, 0), 0);  // half of it on each side
  EXPECT_EQ(between.texel(1, 1), (Texel{180, 180, 180, 128}));               // 255 · √½ = 180.3
  EXPECT_EQ(between.texel(2, 1), (Texel{180, 180, 180, 128}));
}

TEST(CrossFade, ColoursAreThoseInWhichTheSpritesAreShown) {
  const Sprite old = of_one_texel({1, 1}, {0, 0}, {255, 255, 255, 255});
  const Sprite fresh = of_one_texel({1, 1}, {0, 0}, {255, 255, 255, 255});
  const Sprite mixed = cross_fade({old, {0, 1, 1}}, {fresh, {1, 0.5f, 1}}, dmat3(1), 0.5);
  // Red ½, green ½ + ¼, blue 1, and alpha is left alone.
  EXPECT_EQ(mixed.texel(0, 0), (Texel{180, 221, 255, 255}));
}

TEST(CrossFade, MapsThatSayNothingShowNothingOfTheOldSprite) {
  const Sprite old = of_one_texel({2, 2}, {0, 0}, {255, 255, 255, 255});
  const Sprite fresh = of_one_texel({2, 2}, {1, 1}, {255, 0, 0, 255});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const dmat3& map : {dmat3(nan), dmat3(0.0), dmat3{1, 0, 0, 0, 1, 0, 0, 0, -1}, shifted_by(1e300, 0)}) {
    const Sprite mixed = cross_fade({old}, {fresh}, map, 0.5);
    EXPECT_EQ(mixed.texel(0, 0), Texel{});
    EXPECT_EQ(mixed.texel(1, 1), (Texel{180, 0, 0, 128}));
  }
}

TEST(CrossFade, OfSpritesOfNoSizeHasNone) {
  const Sprite none, old = of_one_texel({1, 1}, {0, 0}, {1, 1, 1, 1});
  EXPECT_EQ(cross_fade({old}, {none}, dmat3(1), 0.5).size_px(), layers::ivec2(0, 0));
  const Sprite faded = cross_fade({none}, {old}, dmat3(1), 1);
  EXPECT_EQ(faded.texel(0, 0), (Texel{1, 1, 1, 1}));
}

}  // namespace
}  // namespace talisman::chunker
