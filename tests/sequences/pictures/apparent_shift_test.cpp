// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/apparent_shift.h"

#include <cmath>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

/// A disc of 60 px with soft waves on it, in the middle of 200 × 160 px; `moved` displaces it.
chunker::Frame disc(double moved_x, double moved_y, double brightness = 1) {
  chunker::Frame frame{200, 160, {}};
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const double u = x + 0.5 - 100 - moved_x, v = y + 0.5 - 80 - moved_y;
      const double cover = std::clamp(60.5 - std::hypot(u, v), 0.0, 1.0);
      const double wave = 0.5 + 0.2 * std::sin(u / 5) + 0.2 * std::sin(v / 6 + u / 17);
      const auto c = static_cast<std::uint16_t>(cover * wave * brightness * chunker::kOne);
      frame.pixels.push_back(
          {c, c, static_cast<std::uint16_t>(c / 2), static_cast<std::uint16_t>(cover * chunker::kOne)});
    }
  return frame;
}

TEST(ApparentShift, OfTheSamePictureIsNothing) {
  const ApparentShift same = apparent_shift(disc(0, 0), disc(0, 0), 4);
  EXPECT_EQ(same.p95_px, 0);
  EXPECT_EQ(same.rms, 0);
  EXPECT_EQ(same.missing, 0);
  EXPECT_GT(same.structured_px, 5000);
}

TEST(ApparentShift, IsTheDisplacementAndExplainsTheDifference) {
  for (const auto& [x, y] : {std::pair{0.5, 0.0}, {1.3, -0.8}, {-3.0, 2.0}, {6.0, 1.0}}) {
    const double length = std::hypot(x, y);
    const ApparentShift moved = apparent_shift(disc(x, y), disc(0, 0), length + 0.5);
    EXPECT_NEAR(moved.mean_px, length, 0.1 + 0.05 * length) << x << ' ' << y;
    EXPECT_LT(moved.p95_px, 1.1 * length + 0.25) << x << ' ' << y;
    EXPECT_LT(moved.rms, 0.01) << x << ' ' << y;
  }
}

TEST(ApparentShift, LongerThanExplainedIsLeftOver) {
  EXPECT_GT(apparent_shift(disc(3, 0), disc(0, 0), 0).rms, 0.04);
}

TEST(ApparentShift, LightIsNoShift) {
  const ApparentShift dimmed = apparent_shift(disc(0, 0, 0.8), disc(0, 0), 1);
  // Of square roots: 1 - √0.8 of √(1/2 + 1/2 + 1/4), the mean wave in two channels and half of it in the third.
  EXPECT_NEAR(dimmed.rms, (1 - std::sqrt(0.8)) * std::sqrt(1.25), 0.01);
}

TEST(ApparentShift, WhatTheSpriteDoesNotHaveIsMissing) {
  chunker::Frame half = disc(0, 0);
  for (int y = 0; y < half.height; ++y)
    for (int x = 100; x < half.width; ++x) half.pixels[static_cast<std::size_t>(y * half.width + x)] = {};
  EXPECT_NEAR(apparent_shift(half, disc(0, 0), 0).missing, 0.5, 0.03);
  EXPECT_EQ(apparent_shift(disc(0, 0), half, 0).missing, 0);
}

TEST(ApparentShift, ClearPicturesAreNotSeen) {
  chunker::Frame clear{20, 20, std::vector<chunker::Linear16>(400)};
  EXPECT_EQ(apparent_shift(clear, clear, 1).seen.width, 0);
  EXPECT_EQ(apparent_shift(clear, clear, 1).p95_px, 0);
}

}  // namespace
}  // namespace talisman::sequences
