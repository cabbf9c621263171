// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/popping.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace talisman::sequences {
namespace {

using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::ivec2;

Image8 flat(int width, int height, int value) {
  return {width, height,
          std::vector<std::uint8_t>(std::size_t(width) * height * 3, static_cast<std::uint8_t>(value))};
}

/// A white box of 4 × 4 pixels on black, its left side at x.
Image8 box_at(int x) {
  Image8 image = flat(20, 8, 0);
  for (int row = 2; row < 6; ++row)
    for (int column = x; column < x + 4; ++column)
      for (int c = 0; c < 3; ++c) image.rgb[(row * 20 + column) * 3 + c] = 255;
  return image;
}

PixelMask everywhere(const Image8& image) { return PixelMask(image.rgb.size() / 3, 1); }

Popping popping_of(const ConsecutiveFrames& shown, const ConsecutiveFrames& truth,
                   const PixelMask& stepping) {
  PoppingMeter meter;
  meter.add(shown, truth, stepping);
  return meter.result();
}

TEST(PoppingMeter, TheReferenceDoesNotPopHoweverItMoves) {
  const Image8 before = box_at(3), now = box_at(11);
  const Popping popping = popping_of({before, now}, {before, now}, everywhere(now));
  EXPECT_EQ(popping.rms, 0);
  EXPECT_EQ(popping.p95, 0);
}

TEST(PoppingMeter, AConstantErrorDoesNotPop) {
  // The truth brightens by 40; what is shown is 10 too dark in both frames.
  const Image8 shown_before = flat(5, 4, 90), shown_now = flat(5, 4, 130);
  const Image8 before = flat(5, 4, 100), now = flat(5, 4, 140);
  const Popping popping = popping_of({shown_before, shown_now}, {before, now}, everywhere(now));
  EXPECT_EQ(popping.rms, 0);
  EXPECT_EQ(popping.p95, 0);
}

TEST(PoppingMeter, TheStepIsTheChangeOfTheErrorWhereverTheTruthGoes) {
  // 10 too dark, then 20 too bright: a step of 30. The truth moves by 7.
  const Image8 shown_before = flat(5, 4, 90), shown_now = flat(5, 4, 127);
  const Image8 before = flat(5, 4, 100), now = flat(5, 4, 107);
  const Popping popping = popping_of({shown_before, shown_now}, {before, now}, everywhere(now));
  EXPECT_DOUBLE_EQ(popping.rms, 30);
  EXPECT_EQ(popping.p95, 30);
  EXPECT_EQ(popping.elsewhere_rms, 0);
}

TEST(PoppingMeter, ASpriteThatJumpsBackToItsPlace) {
  // The box stands at 8 and was shown 2 px too far left. When it is drawn again 2 columns of 4 pixels appear
  // and 2 disappear: 16 of the 32 pixels of its rectangle (8 × 4) step by 255, so RMS = 255 √(16 / 32).
  PixelMask rectangle(20 * 8, 0);
  for (int row = 2; row < 6; ++row)
    for (int column = 5; column < 13; ++column) rectangle[row * 20 + column] = 1;
  const Image8 off = box_at(6), right = box_at(8);
  const Popping popping = popping_of({off, right}, {right, right}, rectangle);
  EXPECT_NEAR(popping.rms, 255 * std::sqrt(0.5), 1e-12);
  EXPECT_EQ(popping.p95, 255);
  EXPECT_EQ(popping.elsewhere_rms, 0);
  EXPECT_DOUBLE_EQ(popping.stepping_share, 32.0 / 160);
}

TEST(PoppingMeter, ChangeOutsideOfRedrawnSpritesIsKeptApart) {
  const Image8 shown_before = flat(2, 1, 100), truth = flat(2, 1, 100);
  Image8 shown_now = shown_before;
  shown_now.rgb[0] = 106;  // red of the left pixel, which is not drawn again
  const Popping popping = popping_of({shown_before, shown_now}, {truth, truth}, {0, 1});
  EXPECT_EQ(popping.rms, 0);
  EXPECT_DOUBLE_EQ(popping.elsewhere_rms, 6 / std::sqrt(3.0));
}

TEST(PoppingMeter, LargestPossibleStep) {
  // From 255 too bright to 255 too dark.
  const Image8 black = flat(3, 3, 0), white = flat(3, 3, 255);
  const Popping popping = popping_of({white, black}, {black, white}, everywhere(black));
  EXPECT_DOUBLE_EQ(popping.rms, 510);
  EXPECT_EQ(popping.p95, 510);
}

TEST(PoppingMeter, PercentileIsTheStepThatNineteenInTwentyPixelsDoNotExceed) {
  const Image8 truth = flat(100, 1, 0), before = flat(100, 1, 0);
  for (const int loud : {5, 6}) {
    Image8 now = flat(100, 1, 1);
    for (int x = 0; x < loud; ++x) now.rgb[3 * x] = 200;
    EXPECT_EQ(popping_of({before, now}, {truth, truth}, everywhere(now)).p95, loud == 5 ? 1 : 200) << loud;
  }
}

TEST(PoppingMeter, FramesArePooledByPixels) {
  // 4 pixels that step by 10 and 12 that step by 2: √((4 · 100 + 12 · 4) / 16).
  const Image8 zero4 = flat(2, 2, 0), ten = flat(2, 2, 10), zero12 = flat(4, 3, 0), two = flat(4, 3, 2);
  PoppingMeter meter;
  meter.add({zero4, ten}, {zero4, zero4}, everywhere(ten));
  meter.add({zero12, two}, {zero12, zero12}, everywhere(two));
  meter.add({zero4, ten}, {zero4, zero4}, PixelMask(4, 0));  // no re-render: no step
  const Popping popping = meter.result();
  EXPECT_NEAR(popping.rms, std::sqrt((4 * 100 + 12 * 4) / 16.0), 1e-12);
  EXPECT_EQ(popping.frames, 3);
  EXPECT_EQ(popping.frames_with_steps, 2);
}

// No redraw in any frame that was compared says nothing of how hard redraws pop.
TEST(PoppingMeter, NothingDrawnAgainIsNoNumber) {
  const Image8 picture = flat(2, 1, 100);
  for (const Popping& popping :
       {PoppingMeter().result(), popping_of({picture, picture}, {picture, picture}, {0, 0})}) {
    EXPECT_TRUE(std::isnan(popping.rms));
    EXPECT_TRUE(std::isnan(popping.p95));
    EXPECT_EQ(popping.elsewhere_rms, 0);
  }
  const Popping popping = PoppingMeter().result();
  EXPECT_EQ(popping.stepping_share, 0);
}

// --- Where

constexpr ivec2 kDisplay{32, 24};
const std::vector<int> kShownBefore{0};

/// A frame that shows one sprite, opaque to the left of texel `clear_from_x`.
struct OneSprite {
  FrameReport report;
  chunker::SpriteStore store;

  OneSprite(const dmat3& screen_from_sprite, ivec2 size_px,
            regulator::Action action = regulator::Action::Rerender, int clear_from_x = 1000) {
    report.plan.decisions.resize(1);
    report.plan.decisions[0].action = action;
    report.shown.push_back({0, screen_from_sprite, size_px, 0, {}});
    report.shown[0].steps = action == regulator::Action::Rerender;
    chunker::Sprite sprite(size_px);
    for (int row = 0; row < sprite.chunks().y; ++row)
      for (int column = 0; column < sprite.chunks().x; ++column) {
        chunker::Chunk chunk{};
        for (int y = 0; y < 32; ++y)
          for (int x = 0; x < 32; ++x)
            if (32 * column + x < std::min(size_px.x, clear_from_x) && 32 * row + y < size_px.y)
              chunk.texels[32 * y + x] = {9, 9, 9, 255};
        sprite.store(column, row, chunk);
      }
    store.put(0, std::move(sprite));
  }

  PixelMask mask(const std::vector<int>& shown_before = kShownBefore) const {
    return stepping_pixels(shown_before, report, store, kDisplay);
  }
};

dmat3 shifted(double x, double y) { return {1, 0, 0, 0, 1, 0, x, y, 1}; }

int area(const PixelMask& mask) { return std::accumulate(mask.begin(), mask.end(), 0); }

TEST(SteppingPixels, AreThoseWhoseCentreIsInTheRectangle) {
  // From 3.6 to 8.6: the centres 4.5 … 8.5; from 2 to 6: the centres 2.5 … 5.5.
  const PixelMask mask = OneSprite(shifted(3.6, 2), {5, 4}).mask();
  EXPECT_EQ(area(mask), 5 * 4);
  EXPECT_EQ(mask[2 * 32 + 3], 0);
  EXPECT_EQ(mask[2 * 32 + 4], 1);
  EXPECT_EQ(mask[5 * 32 + 8], 1);
}

TEST(SteppingPixels, ClearTexelsCannotJump) {
  EXPECT_EQ(area(OneSprite(shifted(3, 2), {10, 4}, regulator::Action::Rerender, 6).mask()), 6 * 4);
  EXPECT_EQ(area(OneSprite(shifted(3, 2), {10, 4}, regulator::Action::Rerender, 0).mask()), 0);
}

TEST(SteppingPixels, OnlySpritesThatAreDrawnAgain) {
  EXPECT_EQ(area(OneSprite(shifted(3, 2), {5, 4}, regulator::Action::Reuse).mask()), 0);
  EXPECT_EQ(area(OneSprite(shifted(3, 2), {5, 4}).mask({})), 0) << "a first appearance does not jump";
}

TEST(SteppingPixels, RectanglesBeyondTheDisplayAreCut) {
  EXPECT_EQ(area(OneSprite(shifted(-10, -10), {100, 100}).mask()), 32 * 24);
  EXPECT_EQ(area(OneSprite(shifted(30, 20), {100, 100}).mask()), 2 * 4);
  EXPECT_EQ(area(OneSprite(shifted(500, 500), {10, 10}).mask()), 0);
  EXPECT_EQ(area(OneSprite(shifted(1e300, 0), {10, 10}).mask()), 0);
}

TEST(SteppingPixels, MapsThatShowNothingMarkNothing) {
  for (const dmat3& map :
       {dmat3(0.0), dmat3(1, 0, 0, 1, 0, 0, 3, 3, 1), shifted(NAN, 0), shifted(0, HUGE_VAL)})
    EXPECT_EQ(area(OneSprite(map, {8, 8}).mask()), 0);
}

/// Inside by the sides of the image quadrilateral, forwards only.
bool in_quadrilateral(const dmat3& map, ivec2 size, dvec2 p) {
  const dvec2 s(size);
  const dvec2 sprite[] = {{0, 0}, {s.x, 0}, s, {0, s.y}};
  dvec2 corner[4];
  for (int k = 0; k < 4; ++k) {
    const dvec3 q = map * dvec3(sprite[k], 1);
    corner[k] = dvec2(q) / q.z;
  }
  int left = 0, right = 0;
  for (int k = 0; k < 4; ++k) {
    const dvec2 side = corner[(k + 1) % 4] - corner[k], to = p - corner[k];
    (side.x * to.y - side.y * to.x > 0 ? left : right) += 1;
  }
  return left == 4 || right == 4;
}

TEST(SteppingPixels, AgreeWithTheImageOfTheRectangleUnderRandomPerspectiveMaps) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto uniform = [&random](double lo, double hi) {
      return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    const double angle = uniform(0, 6.28), scale = uniform(0.3, 3);
    const dmat3 map{scale * std::cos(angle),  scale * std::sin(angle), uniform(0, 0.02),
                    -scale * std::sin(angle), scale * std::cos(angle), uniform(0, 0.02),
                    uniform(-5, 35),          uniform(-5, 30),         1};
    const ivec2 size{1 + int(random() % 20), 1 + int(random() % 20)};
    const PixelMask mask = OneSprite(map, size).mask();
    for (int y = 0; y < kDisplay.y; ++y)
      for (int x = 0; x < kDisplay.x; ++x)
        ASSERT_EQ(mask[y * kDisplay.x + x] != 0, in_quadrilateral(map, size, {x + 0.5, y + 0.5}))
            << x << " " << y;
  }
}

}  // namespace
}  // namespace talisman::sequences
