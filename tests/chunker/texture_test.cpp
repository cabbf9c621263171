// SPDX-License-Identifier: Apache-2.0
#include "chunker/texture.h"

#include <random>

#include <gtest/gtest.h>

#include "chunker/pixel.h"
#include "tests/support/scenes.h"

namespace talisman::chunker {
namespace {

using layers::coarse_log2;
using layers::power_of_unit;

layers::Texture texture(int width, int height, std::vector<std::uint8_t> rgba) {
  layers::Texture t;
  t.width = width;
  t.height = height;
  t.rgba = std::move(rgba);
  return t;
}

layers::Texture random_texture(int width, int height, unsigned seed, bool alpha) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * height * 4);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = i % 4 == 3 && !alpha ? 255 : static_cast<std::uint8_t>(random());
  return texture(width, height, bytes);
}

Float4 mean_of(const MipLevel& level) {
  double sum[4] = {};
  for (const Float4& t : level.texels)
    for (int c = 0; c < 4; ++c) sum[c] += t[c];
  const double n = static_cast<double>(level.texels.size());
  return Float4{static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n),
                static_cast<float>(sum[2] / n), static_cast<float>(sum[3] / n)};
}

// Sizes that are no powers of two: a 2×2 box would lose a row at each level and drift.
TEST(BuildPyramid, EveryLevelHasTheMeanOfTheTexture) {
  for (const auto& [w, h] : {std::pair{64, 64}, {37, 21}, {5, 1}, {1, 9}, {3, 3}}) {
    const Pyramid pyramid = build_pyramid(random_texture(w, h, 7, true));
    const Float4 expected = mean_of(pyramid.levels[0]);
    for (const MipLevel& level : pyramid.levels)
      for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(mean_of(level)[c], expected[c], 2e-5) << w << "x" << h << " level " << level.width;
    EXPECT_EQ(pyramid.levels.back().width, 1);
    EXPECT_EQ(pyramid.levels.back().height, 1);
  }
}

TEST(BuildPyramid, OpaqueTexturesStayExactlyOpaque) {
  const Pyramid pyramid = build_pyramid(random_texture(37, 53, 3, false));
  EXPECT_TRUE(pyramid.opaque);
  for (const MipLevel& level : pyramid.levels)
    for (const Float4& t : level.texels) ASSERT_EQ(t[3], 1.0f);
}

TEST(BuildPyramid, TexelsArePremultipliedLinear) {
  const Pyramid pyramid = build_pyramid(texture(1, 1, {255, 128, 0, 51}));
  EXPECT_FALSE(pyramid.opaque);
  const Float4 t = pyramid.mean();
  EXPECT_FLOAT_EQ(t[0], 0.2f);
  EXPECT_FLOAT_EQ(t[1], linear_from_srgb(128) * 0.2f);
  EXPECT_EQ(t[2], 0.0f);
  EXPECT_FLOAT_EQ(t[3], 0.2f);
}

// A clear red texel beside an opaque green one must not bleed red: that is why alpha is multiplied in first.
TEST(BuildPyramid, ClearTexelsDoNotBleed) {
  const Float4 t = build_pyramid(texture(2, 1, {255, 0, 0, 0, 0, 255, 0, 255})).mean();
  EXPECT_EQ(t[0], 0.0f);
  EXPECT_FLOAT_EQ(t[1], 0.5f);
  EXPECT_FLOAT_EQ(t[3], 0.5f);
}

TEST(BuildPyramid, WithoutTexelsItIsEmpty) {
  EXPECT_TRUE(build_pyramid(texture(0, 0, {})).empty());
  EXPECT_TRUE(build_pyramid(texture(-1, 5, {})).empty());
  EXPECT_TRUE(build_pyramid(texture(2, 2, {1, 2, 3, 4})).empty());  // fewer bytes than the size asks for
}

TEST(Bilinear, HitsTexelCentresAndRepeats) {
  const Pyramid pyramid = build_pyramid(random_texture(8, 4, 11, true));
  const MipLevel& level = pyramid.levels[0];
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / 8, v = (static_cast<float>(y) + 0.5f) / 4;
      for (const float shift : {0.0f, 1.0f, -3.0f, 1000.0f}) {
        const Float4 t = bilinear(level, u + shift, v - shift);
        for (int c = 0; c < 4; ++c)
          ASSERT_EQ(t[c], level.texels[y * 8 + x][c]) << x << " " << y << " " << shift;
      }
    }
}

// Between the last and the first texel: the border mixes both, and the largest coordinates stay inside the
// array (asan).
TEST(Bilinear, WrapsAtTheBorder) {
  const Pyramid pyramid = build_pyramid(texture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}));
  for (const float u : {0.0f, 1.0f, -1.0f, 7.0f}) EXPECT_FLOAT_EQ(bilinear(pyramid.levels[0], u, 0)[0], 0.5f);
  for (const float u : {-1e-9f, kLargestTextureCoordinate, -kLargestTextureCoordinate, 0.99999994f}) {
    const float value = bilinear(pyramid.levels[0], u, -u)[0];
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1);
  }
}

// Mip seams are steps in colour where the level changes: along a growing footprint there must be none.
TEST(Trilinear, IsContinuousInTheFootprint) {
  const Pyramid pyramid = build_pyramid(talisman::tests::checker_texture(4, 5));
  float before = trilinear(pyramid, 0.3f, 0.6f, 0.5f)[0];
  for (double f = 0.5; f < 1e4; f *= 1.002) {
    const float now = trilinear(pyramid, 0.3f, 0.6f, static_cast<float>(f))[0];
    ASSERT_LT(std::abs(now - before), 0.004f) << f;
    before = now;
  }
}

TEST(Trilinear, OddFootprintsAreHarmless) {
  const Pyramid pyramid = build_pyramid(random_texture(16, 16, 1, true));
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (int c = 0; c < 4; ++c) {
    EXPECT_EQ(trilinear(pyramid, 0.2f, 0.2f, inf)[c], pyramid.mean()[c]);
    EXPECT_EQ(trilinear(pyramid, 0.2f, 0.2f, 1e30f)[c], pyramid.mean()[c]);
    EXPECT_EQ(trilinear(pyramid, 0.2f, 0.2f, nan)[c], bilinear(pyramid.levels[0], 0.2f, 0.2f)[c]);
    EXPECT_EQ(trilinear(pyramid, 0.2f, 0.2f, 0)[c], bilinear(pyramid.levels[0], 0.2f, 0.2f)[c]);
  }
}

// Two black texels and two white ones; the coarser levels are black and white, and grey. At u = 0.4 the levels give
// bilinearly 0.1, 0.3 and 0.5, by the nearest texel 0, 0 and 0.5. The footprint is 4^λ.
TEST(AsTextureSays, EachFilterOfMinifiedTextures) {
  const auto value = [](bool layers::Texture::*a, bool layers::Texture::*b, float footprint) {
    layers::Texture two_and_two =
        texture(4, 1, {0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255});
    two_and_two.*a = two_and_two.*b = true;
    return as_texture_says(build_pyramid(two_and_two), 0.4f, 0, footprint)[0];
  };
  using T = layers::Texture;
  EXPECT_EQ(value(&T::nearest, &T::nearest, 1), 0);
  EXPECT_NEAR(value(&T::nearest, &T::nearest, 4), 0.3, 1e-6);
  EXPECT_NEAR(value(&T::nearest_minified, &T::nearest_minified, 1), 0.1, 1e-6);
  EXPECT_EQ(value(&T::nearest_minified, &T::nearest_minified, 4), 0);
  EXPECT_NEAR(value(&T::nearest_minified, &T::nearest_minified, 8), 0.25, 1e-6);  // λ = 1.5
  EXPECT_NEAR(value(&T::one_level, &T::one_level, 1.9f), 0.1, 1e-6);              // λ < ½
  EXPECT_NEAR(value(&T::one_level, &T::one_level, 2.1f), 0.3, 1e-6);
  EXPECT_EQ(value(&T::one_level, &T::one_level, 1e9f), 0.5f);
  EXPECT_EQ(value(&T::one_level, &T::nearest_minified, 2.1f), 0);
  EXPECT_NEAR(value(&T::finest, &T::finest, 100), 0.1, 1e-6);
  EXPECT_EQ(value(&T::finest, &T::nearest_minified, 100), 0);
}

TEST(CoarseLog2, IsMonotoneAndClose) {
  float before = coarse_log2(1e-6f);
  for (double x = 1e-6; x < 1e9; x *= 1.0007) {
    const float now = coarse_log2(static_cast<float>(x));
    ASSERT_NEAR(now, std::log2(x), 1e-2) << x;
    ASSERT_GE(now, before) << x;
    before = now;
  }
  for (int e = -20; e <= 20; ++e) EXPECT_EQ(coarse_log2(std::ldexp(1.0f, e)), static_cast<float>(e));
}

TEST(PowerOfUnit, AgreesWithTheLibrary) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int n = 0; n < 20000; ++n) {
    const float x = unit(random), y = std::pow(10.0f, 6 * unit(random) - 2);  // 0.01 … 1e4
    const double expected = std::pow(static_cast<double>(x), static_cast<double>(y));
    ASSERT_NEAR(power_of_unit(x, y), expected, 1e-6 * expected + 1e-37) << x << " " << y;
  }
}

TEST(PowerOfUnit, BordersOfItsRange) {
  EXPECT_EQ(power_of_unit(0, 0), 0);
  EXPECT_EQ(power_of_unit(-0.5f, 2), 0);
  EXPECT_EQ(power_of_unit(0.5f, 0), 1);
  EXPECT_EQ(power_of_unit(1.0000001f, 1e4f), 1);
  EXPECT_EQ(power_of_unit(0.5f, 1e4f), 0);
  EXPECT_EQ(power_of_unit(std::numeric_limits<float>::quiet_NaN(), 2), 0);
}

}  // namespace
}  // namespace talisman::chunker
