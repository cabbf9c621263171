// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/apparent_shift.h"

#include <algorithm>
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
  const ApparentShift same = apparent_shift(disc(0, 0), disc(0, 0), {4});
  EXPECT_EQ(same.p95_px, 0);
  EXPECT_EQ(same.rms, 0);
  EXPECT_EQ(same.missing, 0);
  EXPECT_GT(same.structured_px, 5000);
}

TEST(ApparentShift, IsTheDisplacementAndExplainsTheDifference) {
  for (const auto& [x, y] : {std::pair{0.5, 0.0}, {1.3, -0.8}, {-3.0, 2.0}, {6.0, 1.0}}) {
    const double length = std::hypot(x, y);
    const ApparentShift moved = apparent_shift(disc(x, y), disc(0, 0), {length + 0.5});
    EXPECT_NEAR(moved.mean_px, length, 0.1 + 0.05 * length) << x << ' ' << y;
    EXPECT_LT(moved.p95_px, 1.1 * length + 0.25) << x << ' ' << y;
    EXPECT_LT(moved.rms, 0.01) << x << ' ' << y;
  }
}

TEST(ApparentShift, LongerThanExplainedIsLeftOver) {
  EXPECT_GT(apparent_shift(disc(3, 0), disc(0, 0), {0}).rms, 0.04);
}

TEST(ApparentShift, LightIsNoShift) {
  const ApparentShift dimmed = apparent_shift(disc(0, 0, 0.8), disc(0, 0), {0});
  // 0.2 of the waves (mean square 1/4 + 0.02 + 0.02) in two channels and of half of them in the third.
  EXPECT_NEAR(dimmed.rms, 0.2 * std::sqrt(2.25 * 0.29), 0.01);
  // A pixel of displacement explains at most what the waves change in a pixel: 0.2 (1/5 + 1/17 + 1/6), halved by
  // their phases.
  const double most = 0.5 * 0.2 * (1.0 / 5 + 1.0 / 17 + 1.0 / 6) * 1.5;
  EXPECT_GT(apparent_shift(disc(0, 0, 0.8), disc(0, 0), {1}).rms, dimmed.rms - most);
}

TEST(ApparentShift, OfASoftLightThatPassesOverAnEvenSurfaceIsNone) {
  // A wide, weak ramp moves by 5 px: what is seen is less than a code value of light, not a displacement.
  const auto ramp = [](double moved) {
    chunker::Frame frame{120, 90, {}};
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        const double light = 0.5 + 0.05 * std::sin((x - moved) / 40);
        const auto c = static_cast<std::uint16_t>(light * chunker::kOne);
        frame.pixels.push_back({c, c, c, static_cast<std::uint16_t>(chunker::kOne)});
      }
    return frame;
  };
  const ApparentShift passed = apparent_shift(ramp(5), ramp(0), {0.1});
  EXPECT_LT(passed.p95_px, 0.5);
  EXPECT_NEAR(passed.rms, 0.05 * 5 / 40 * std::sqrt(3.0 / 2), 0.003);
}

/// A ramp of light, dark at the left, with a step in the middle; both may be moved.
chunker::Frame ramp_with_step(double ramp_px, double step_px, double step) {
  chunker::Frame frame{70, 90, {}};
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const double light = 0.05 + 0.012 * (x - ramp_px) + step * std::clamp(x - 35 - step_px, 0.0, 1.0);
      const auto c = static_cast<std::uint16_t>(std::min(light, 1.0) * chunker::kOne);
      frame.pixels.push_back({c, c, c, static_cast<std::uint16_t>(chunker::kOne)});
    }
  return frame;
}

TEST(ApparentShift, OfALightThatIsKnownToChangeIsNone) {
  // A ramp that moves by 2 px changes every colour by 0.024 √3 = 0.0416.
  const chunker::Frame before = ramp_with_step(2, 0, 0), after = ramp_with_step(0, 0, 0);
  EXPECT_NEAR(apparent_shift(before, after, {0, 0}).p95_px, 2, 0.5);
  EXPECT_NEAR(apparent_shift(before, after, {0, 0.01}).p95_px, 2, 0.8);  // less is known than there is
  EXPECT_EQ(apparent_shift(before, after, {0, 0.043}).p95_px, 0);
  EXPECT_NEAR(apparent_shift(before, after, {0, 0.043}).rms, 0.0416, 0.001);
  // A step that moves by 3 px is a displacement, whatever light is known to change beside it.
  EXPECT_NEAR(apparent_shift(ramp_with_step(0, 3, 0.2), ramp_with_step(0, 0, 0.2), {0, 0.03}).p95_px, 3, 0.8);
}

TEST(ApparentShift, OfADarkSilhouetteIsNoLight) {
  const auto dark = [](double moved) { return disc(moved, 0, 0.02); };
  EXPECT_NEAR(apparent_shift(dark(2), dark(0), {0, 0.1}).p95_px,
              apparent_shift(dark(2), dark(0), {0, 0}).p95_px, 0.3);
}

TEST(ApparentShift, AlongAStraightEdgeIsTheMotionAcross) {
  const auto edge = [](double moved_x, double moved_y) {
    chunker::Frame frame{120, 90, {}};
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        const double across = (x + 0.5 - 60 - moved_x) * 0.8 + (y + 0.5 - 45 - moved_y) * 0.6;
        const auto c = static_cast<std::uint16_t>(std::clamp(0.5 + across, 0.1, 0.9) * chunker::kOne);
        frame.pixels.push_back({c, c, c, static_cast<std::uint16_t>(chunker::kOne)});
      }
    return frame;
  };
  EXPECT_NEAR(apparent_shift(edge(2, 0), edge(0, 0), {2}).mean_px, 1.6, 0.25);  // 2 · 0.8
  EXPECT_LT(apparent_shift(edge(3, -4), edge(0, 0), {2}).p95_px, 0.1);          // along it
}

TEST(ApparentShift, WhatTheSpriteDoesNotHaveIsMissing) {
  chunker::Frame half = disc(0, 0);
  for (int y = 0; y < half.height; ++y)
    for (int x = 100; x < half.width; ++x)
      half.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(half.width) +
                  static_cast<std::size_t>(x)] = {};
  EXPECT_NEAR(apparent_shift(half, disc(0, 0), {0}).missing, 0.5, 0.03);
  EXPECT_EQ(apparent_shift(disc(0, 0), half, {0}).missing, 0);
}

TEST(ApparentShift, ClearPicturesAreNotSeen) {
  chunker::Frame clear{20, 20, std::vector<chunker::Linear16>(400)};
  EXPECT_EQ(apparent_shift(clear, clear, {1}).seen.width, 0);
  EXPECT_EQ(apparent_shift(clear, clear, {1}).p95_px, 0);
}

}  // namespace
}  // namespace talisman::sequences
