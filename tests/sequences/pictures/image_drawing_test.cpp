// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/image_drawing.h"

#include <algorithm>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace talisman::sequences {
namespace {

constexpr Rgb kBlack{0, 0, 0}, kWhite{255, 255, 255};

Rgb at(const Image8& image, int x, int y) {
  const auto* p = image.rgb.data() + (static_cast<std::size_t>(y) * image.width + x) * 3;
  return {p[0], p[1], p[2]};
}

Image8 noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image8 image = plain_image(width, height, kBlack);
  for (std::uint8_t& value : image.rgb) value = static_cast<std::uint8_t>(random());
  return image;
}

int lit_pixels(const Image8& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += at(image, x, y) != kBlack;
  return count;
}

TEST(DrawText, LettersFillTheirBoxAndStayInIt) {
  for (const int scale : {1, 2})
    for (const std::string text : {"Tyg", "canyon/0 12", "|_j", "0"}) {
      Image8 image = plain_image(200, 60, kBlack);
      draw_text(image, text, {20, 10}, {10, 200, 90}, scale);
      const layers::ivec2 size = text_size(text, scale);
      int lit = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          if (at(image, x, y) == kBlack) continue;
          ++lit;
          ASSERT_TRUE(x >= 18 && x <= 21 + size.x && y >= 8 && y <= 11 + size.y)
              << text << " at " << x << ", " << y << ", scale " << scale;
          ASSERT_GE(at(image, x, y)[1], at(image, x, y)[2]) << "green above blue above red";
        }
      EXPECT_GT(lit, 8 * scale) << text;
    }
}

TEST(DrawText, ScaleTwoIsLargerAndLongerTextIsWider) {
  EXPECT_GT(text_size("layer", 2).x, text_size("layer", 1).x);
  EXPECT_GT(text_size("layer", 2).y, text_size("layer", 1).y);
  EXPECT_GT(text_size("layers", 1).x, text_size("layer", 1).x);
  EXPECT_LE(text_size("", 1).x, 1);
}

TEST(DrawText, LettersDifferSmallOnesToo) {
  std::set<std::vector<std::uint8_t>> seen;
  const std::string letters = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.,:-_+/#%=()*";
  for (const char c : letters) {
    Image8 image = plain_image(40, 40, kBlack);
    draw_text(image, std::string(1, c), {10, 10}, kWhite, 2);
    EXPECT_GT(lit_pixels(image), 0) << c;
    seen.insert(image.rgb);
  }
  EXPECT_EQ(seen.size() + 1, letters.size()) << "I and l are the same stroke";
}

TEST(DrawText, SignsBeyondAsciiAreOneQuestionMarkEach) {
  Image8 sign = plain_image(60, 30, kBlack), mark = sign;
  draw_text(sign, "a\u00e9\u20ac\x01", {5, 5}, kWhite, 1);
  draw_text(mark, "a\?\?\?", {5, 5}, kWhite, 1);
  EXPECT_EQ(sign.rgb, mark.rgb);
}

TEST(DrawText, OutsideIsLeftOutAndAnEmptyPictureStaysEmpty) {
  Image8 image = plain_image(30, 20, kBlack), empty;
  for (const layers::ivec2 place : {layers::ivec2{-1000, 5}, {1000, 5}, {5, -1000}, {5, 1000}})
    draw_text(image, "text", place, kWhite, 1);
  EXPECT_EQ(lit_pixels(image), 0);
  draw_text(image, "text", {-5, -3}, kWhite, 2);
  EXPECT_GT(lit_pixels(image), 0);
  draw_text(empty, "text", {0, 0}, kWhite, 1);
  EXPECT_TRUE(empty.rgb.empty());
}

TEST(Tint, MixesInsideOnly) {
  Image8 image = plain_image(10, 10, {100, 100, 100});
  tint(image, {-5, -5, 8, 8}, {200, 0, 100}, 0.5);
  tint(image, {50, 50, 8, 8}, kWhite, 1);
  EXPECT_EQ(at(image, 2, 2), (Rgb{150, 50, 100}));
  EXPECT_EQ(at(image, 3, 2), (Rgb{100, 100, 100}));
}

TEST(Paste, LaysTheOverlapAndLeavesTheRest) {
  const Image8 picture = noise(6, 5, 1);
  for (const layers::ivec2 place : {layers::ivec2{0, 0}, {-3, 2}, {7, -2}, {4, 4}, {-6, 0}, {100, 100}}) {
    Image8 image = plain_image(10, 8, {1, 2, 3});
    paste(image, picture, place);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 10; ++x) {
        const int px = x - place.x, py = y - place.y;
        const bool covered = px >= 0 && py >= 0 && px < 6 && py < 5;
        ASSERT_EQ(at(image, x, y), covered ? at(picture, px, py) : (Rgb{1, 2, 3})) << x << ", " << y;
      }
  }
}

TEST(Cropped, TakesTheRectangle) {
  const Image8 image = noise(9, 7, 2), part = cropped(image, {2, 3, 4, 2});
  ASSERT_EQ(part.width, 4);
  ASSERT_EQ(part.height, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_EQ(at(part, x, y), at(image, x + 2, y + 3));
}

// Factors whose reciprocal is no double (49 is the smallest that a product with it misses) included.
TEST(Enlarged, EveryPixelIsASquare) {
  const Image8 image = noise(5, 4, 3);
  for (const int scale : {1, 2, 3, 7, 12, 49, 98}) {
    const Image8 large = enlarged(image, scale);
    ASSERT_EQ(large.width, 5 * scale);
    ASSERT_EQ(large.height, 4 * scale);
    for (int y = 0; y < large.height; ++y)
      for (int x = 0; x < large.width; ++x)
        ASSERT_EQ(at(large, x, y), at(image, x / scale, y / scale)) << x << ", " << y << " scale " << scale;
  }
}

TEST(Magnified, ShowsThePartAroundTheCentreAndStaysInside) {
  const Image8 image = noise(40, 30, 4);
  const Image8 middle = magnified(image, {20, 15}, {30, 20}, 5);  // 6 × 4 pixels
  ASSERT_EQ(middle.width, 30);
  EXPECT_EQ(at(middle, 0, 0), at(image, 17, 13));
  EXPECT_EQ(at(middle, 29, 19), at(image, 22, 16));
  const Image8 corner = magnified(image, {39, 29}, {30, 20}, 5);
  EXPECT_EQ(at(corner, 29, 19), at(image, 39, 29));
  const Image8 small = magnified(noise(3, 2, 5), {1, 1}, {30, 20}, 5);
  EXPECT_EQ(at(small, 14, 9), at(noise(3, 2, 5), 2, 1));
  EXPECT_EQ(at(small, 15, 9), at(small, 29, 19)) << "paper";
}

TEST(Difference, IsAbsoluteAndClamped) {
  const auto grey = [](std::uint8_t v) { return plain_image(2, 2, {v, v, v}); };
  EXPECT_THAT(difference(grey(10), grey(40), 4).rgb, testing::Each(120));
  EXPECT_THAT(difference(grey(40), grey(10), 64).rgb, testing::Each(255));
  EXPECT_EQ(largest_difference(grey(40), grey(10)), 30);
  EXPECT_EQ(largest_difference(grey(40), grey(40)), 0);
}

TEST(ImageDrawing, IsTheSameForAnyNumberOfThreads) {
  const auto picture = [](int threads) {
    cv::setNumThreads(threads);
    Image8 image = noise(700, 500, 6);
    draw_text(image, "threads", {20, 20}, kWhite, 2);
    draw_line(image, {3.25, 400.5}, {690.75, 10}, {250, 10, 20});
    tint(image, {100, 100, 400, 300}, kWhite, 0.3);
    return difference(enlarged(image, 3), enlarged(noise(700, 500, 7), 3), 2).rgb;
  };
  const int before = cv::getNumThreads();
  EXPECT_EQ(picture(1), picture(4));
  cv::setNumThreads(before);
}

}  // namespace
}  // namespace talisman::sequences
