// SPDX-License-Identifier: Apache-2.0
#include "chunker/pixel.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "chunker/encode_row.h"

namespace talisman::chunker {
namespace {

// Every byte of a sprite must survive decoding and encoding, or sprites would drift when they are drawn into
// each other.
TEST(Encode, InvertsDecodeForEveryByte) {
  for (int v = 0; v < 256; ++v) {
    const auto byte = static_cast<std::uint8_t>(v);
    const Linear16 wide = decode(Texel{byte, byte, byte, byte});
    const LinearColor c{wide.r / 65025.0f, wide.g / 65025.0f, wide.b / 65025.0f, wide.a / 65025.0f};
    EXPECT_EQ(encode(c), (Texel{byte, byte, byte, byte})) << v;
  }
}

TEST(Encode, ClampsAndTurnsNaNIntoZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(encode({2, -1, nan, 1.5f}), (Texel{255, 0, 0, 255}));
  EXPECT_EQ(encode({inf, -inf, 1, nan}), (Texel{255, 0, 255, 0}));
}

TEST(Encode, IsMonotone) {
  for (int i = 1; i <= 100000; ++i)
    ASSERT_LE(encode_sqrt(static_cast<float>(i - 1) * 1e-5f), encode_sqrt(static_cast<float>(i) * 1e-5f))
        << i;
}

// The lanes must give the bytes of the one-texel formula, for any number of texels, in and far out of range.
TEST(EncodeRow, EqualsEncodeBitByBit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> wide(-0.5f, 1.5f);
  for (int count = 0; count <= 33; ++count) {
    std::vector<Float4> colors(static_cast<std::size_t>(count));
    for (Float4& c : colors)
      c = Float4{wide(random), random() % 8 ? wide(random) : std::numeric_limits<float>::quiet_NaN(),
                 random() % 8 ? wide(random) : std::numeric_limits<float>::infinity(), wide(random)};
    std::vector<Texel> texels(colors.size() + 1, Texel{1, 2, 3, 4});
    encode_row(colors.data(), count, texels.data());
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(texels[i], encode({colors[i][0], colors[i][1], colors[i][2], colors[i][3]}))
          << count << " " << i;
    EXPECT_EQ(texels[count], (Texel{1, 2, 3, 4})) << "written beyond the row";
  }
}

TEST(Decode, WhiteIsOne) { EXPECT_EQ(decode(Texel{255, 255, 255, 255}), (Linear16{kOne, kOne, kOne, kOne})); }

TEST(LinearFromSrgb, FollowsTheStandard) {
  EXPECT_EQ(linear_from_srgb(0), 0.0f);
  EXPECT_EQ(linear_from_srgb(255), 1.0f);
  EXPECT_NEAR(linear_from_srgb(128), 0.21586, 1e-5);            // a published value of the curve
  EXPECT_NEAR(linear_from_srgb(10), 10 / 255.0 / 12.92, 1e-9);  // still on the straight piece
}

// 16-bit linear is finer than 8-bit sRGB everywhere but in the very dark, where a step of sRGB is five of
// ours.
TEST(SrgbFromLinear16, InvertsLinearFromSrgbForEveryByte) {
  for (int v = 0; v < 256; ++v) {
    const double linear = linear_from_srgb(static_cast<std::uint8_t>(v));
    EXPECT_EQ(srgb_from_linear16(static_cast<std::uint16_t>(linear * kOne + 0.5)), v);
  }
}

TEST(SrgbFromLinear16, IsMonotoneAndSaturates) {
  for (int v = 1; v < 65536; ++v)
    ASSERT_LE(srgb_from_linear16(static_cast<std::uint16_t>(v - 1)),
              srgb_from_linear16(static_cast<std::uint16_t>(v)));
  EXPECT_EQ(srgb_from_linear16(65535), 255);
  EXPECT_EQ(srgb_from_linear16(kOne), 255);
}

}  // namespace
}  // namespace talisman::chunker
