// SPDX-License-Identifier: Apache-2.0
// Sprites that are shown as they were drawn: whole texels from where they lie, the same bytes as by the formulas.
#include "chunker/lattice.h"

#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "chunker/composite.h"
#include "chunker/reference.h"
#include "chunker/span_composite.h"
#include "tests/chunker/composite_fixtures.h"

namespace talisman::chunker {
namespace {

/// round(n / d), halves upwards.
std::uint32_t rounded(std::uint64_t n, std::uint64_t d) {
  return static_cast<std::uint32_t>((2 * n + d) / (2 * d));
}

PackedPixel packed(Linear16 pixel) {
  PackedPixel bytes;
  std::memcpy(&bytes, &pixel, sizeof bytes);
  return bytes;
}

/// Black of this alpha over every value that a channel can have.
void expect_every_value(std::uint8_t alpha, const char* set) {
  alignas(64) static std::array<PackedPixel, kBandLines * kRunPixels> tile;
  Chunk chunk;
  std::fill(std::begin(chunk.texels), std::end(chunk.texels), Texel{0, 0, 0, alpha});
  LatticeJob job;
  job.chunks[0][0] = chunk.texels;
  job.columns = {0, kRunPixels};
  job.lines = {0, kBandLines};
  for (std::uint32_t first = 0; first <= kOne; first += kBandLines * kRunPixels) {
    const auto value = [&](std::size_t i) { return std::min<std::uint32_t>(first + i, kOne); };
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const auto v = static_cast<std::uint16_t>(value(i));
      tile[i] = packed({v, v, v, v});
    }
    blend_lattice(job, tile.data());
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const auto left = static_cast<std::uint16_t>(rounded(std::uint64_t{value(i)} * (255u - alpha), 255));
      const auto with_alpha = static_cast<std::uint16_t>(std::min<std::uint32_t>(left + 255u * alpha, kOne));
      ASSERT_EQ(tile[i], packed({left, left, left, with_alpha}))
          << set << ": alpha " << int{alpha} << " over " << value(i);
    }
  }
}

TEST(Lattice, EveryAlphaOverEveryValueIsRoundedToNearest) {
  for (const std::int64_t set : instruction_sets()) {
    use_instruction_set(set);
    for (int alpha = 0; alpha < 256 && !HasFailure(); ++alpha)
      expect_every_value(static_cast<std::uint8_t>(alpha), instruction_set_name(set));
  }
  use_instruction_set(0);
}

// Each place of a sprite in a tile, so that each vector lies across two chunks once; sides inside and outside of the display.
TEST(Lattice, EveryShiftEqualsTheReference) {
  Random random(11);
  for (const std::int64_t set : instruction_sets()) {
    use_instruction_set(set);
    for (int shift = -70; shift < 70 && !HasFailure(); ++shift) {
      const Sprite sprite = random.sprite(80);
      PlacedSprite p = placed(sprite, affine(1, 0, shift, 0, 1, (shift * 29) % 70));
      if (shift % 3 == 0) p.color_multiplier = {0.5f, 1, 0.25f};
      const ivec2 display{67, 45};
      EXPECT_EQ(difference(composite({&p, 1}, display, {0.1f, 0.9f, 0}).frame,
                           reference::composite({&p, 1}, display, {0.1f, 0.9f, 0})),
                "")
          << instruction_set_name(set) << ", shift " << shift;
    }
  }
  use_instruction_set(0);
}

// Half a weight's step off is still on it; what is further off has weights of its own, and the formulas decide.
TEST(Lattice, NearlyOnItEqualsTheReference) {
  Random random(12);
  const Sprite sprite = random.sprite(80);
  for (const double off : {0.0, 1e-12, 9e-4, 1.1e-3, 0.00195, 0.00196, 0.5}) {
    for (const double sign : {-1.0, 1.0}) {
      const PlacedSprite p = placed(sprite, affine(1, 0, 5 + sign * off, 0, 1, -9 - sign * off));
      EXPECT_EQ(lattice_origin(*tap_map(p.screen_from_sprite)).has_value(), off < 1e-3) << off;
      EXPECT_EQ(difference(composite({&p, 1}, {70, 50}, {0, 0, 0}).frame,
                           reference::composite({&p, 1}, {70, 50}, {0, 0, 0})),
                "")
          << sign * off;
    }
  }
}

TEST(Lattice, OnlyWhatIsShiftedByWholeTexelsIsOnIt) {
  const auto origin = [](const dmat3& map) { return lattice_origin(*tap_map(map)); };
  EXPECT_EQ(origin(affine(1, 0, 3, 0, 1, -7)), ivec2(-3, 7));
  EXPECT_EQ(origin(affine(1, 0, 1e7, 0, 1, 0)), std::nullopt) << "beyond every display";
  EXPECT_EQ(origin(affine(-1, 0, 3, 0, 1, 0)), std::nullopt);
  EXPECT_EQ(origin(affine(0, 1, 3, 1, 0, 0)), std::nullopt);
  EXPECT_EQ(origin(affine(1, 1e-9, 3, 0, 1, 0)), std::nullopt);
  EXPECT_EQ(origin(affine(2, 0, 3, 0, 2, 0)), std::nullopt);
}

TEST(Lattice, ReachIsTheCommonRectangle) {
  const LatticeReach reach = lattice_reach({-3, 7}, {20, 30}, {0, 0, 32, 32});
  EXPECT_EQ(reach.pixels,
            (layers::RectI{3, 0, 23, 23}));  // columns 3 … 22 show texels 0 … 19, rows 0 … 22 texels 7 … 29
  EXPECT_EQ(reach.pixel_count, 20 * 23);
  EXPECT_EQ(reach.bounds.rect, (layers::RectI{0, 7, 20, 30}));
  EXPECT_EQ(lattice_reach({-40, 0}, {20, 30}, {0, 0, 32, 32}).pixel_count, 0);
}

}  // namespace
}  // namespace talisman::chunker
