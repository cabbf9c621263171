// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/picture_sheet.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

Image8 grey(int width, int height, std::uint8_t value = 100) {
  return {width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 3, value)};
}

void paint(Image8& image, const Crop& where, std::uint8_t value) {
  for (int y = where.y; y < where.y + where.height; ++y)
    for (int x = where.x; x < where.x + where.width; ++x)
      for (int c = 0; c < 3; ++c) image.rgb[(std::size_t(y) * image.width + x) * 3 + c] = value;
}

TEST(MostDifferent, FindsTheOneBlockThatDiffers) {
  const Image8 truth = grey(40, 30);
  Image8 other = truth;
  paint(other, {23, 11, 8, 6}, 180);
  const Crop crop = most_different({&other}, truth, 8, 6);
  EXPECT_EQ(crop.x, 23);
  EXPECT_EQ(crop.y, 11);
  EXPECT_EQ(squared_difference({&other}, truth, crop), 80.0 * 80 * 3 * 48);
}

TEST(MostDifferent, EqualsTheSlowSearchOnNoise) {
  // Printed with the failure: the seed is the whole input.
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    Image8 truth = grey(17, 13), a = truth, b = truth;
    for (Image8* image : {&truth, &a, &b})
      for (std::uint8_t& value : image->rgb) value = static_cast<std::uint8_t>(random());
    Crop best;
    double most = -1;
    for (int y = 0; y + 4 <= 13; ++y)
      for (int x = 0; x + 5 <= 17; ++x) {
        double sum = 0;
        for (const Image8* other : {&a, &b})
          for (int j = y; j < y + 4; ++j)
            for (int i = 3 * x; i < 3 * (x + 5); ++i) {
              const double d = double(other->rgb[j * 51 + i]) - truth.rgb[j * 51 + i];
              sum += d * d;
            }
        if (sum > most) most = sum, best = {x, y, 5, 4};
      }
    const Crop found = most_different({&a, &b}, truth, 5, 4);
    EXPECT_EQ(found.x, best.x) << "seed " << seed;
    EXPECT_EQ(found.y, best.y) << "seed " << seed;
    EXPECT_EQ(squared_difference({&a, &b}, truth, found), most) << "seed " << seed;
  }
}

TEST(MostDifferent, OfEqualPicturesIsTheFirstPlace) {
  const Image8 truth = grey(20, 10);
  const Crop crop = most_different({&truth}, truth, 4, 4);
  EXPECT_EQ(crop.x, 0);
  EXPECT_EQ(crop.y, 0);
}

TEST(MostDifferent, OfAPictureSmallerThanTheCropIsAllOfIt) {
  const Image8 truth = grey(5, 3);
  const Crop crop = most_different({&truth}, truth, 128, 96);
  EXPECT_EQ(crop.width, 5);
  EXPECT_EQ(crop.height, 3);
}

TEST(SheetOf, HoldsEveryPictureEnlarged) {
  const Image8 sheet = sheet_of({"title"}, {{{"a"}, {grey(6, 4, 200)}}, {{"b"}, {grey(6, 4, 210)}}}, 3);
  ASSERT_EQ(sheet.rgb.size(), std::size_t(sheet.width) * sheet.height * 3);
  // Letters are antialiased, and may have any grey: the pictures are looked for as whole rows.
  for (const std::uint8_t grey_value : {200, 210}) {
    const std::vector<std::uint8_t> row(6 * 3 * 3, grey_value);
    int rows = 0;
    for (int y = 0; y < sheet.height; ++y) {
      const auto first = sheet.rgb.begin() + std::ptrdiff_t(y) * sheet.width * 3;
      rows += std::search(first, first + sheet.width * 3, row.begin(), row.end()) != first + sheet.width * 3;
    }
    EXPECT_EQ(rows, 4 * 3) << int(grey_value);
  }
  const auto bright = [](std::uint8_t value) { return value > 120 && value != 200 && value != 210; };
  EXPECT_GT(std::count_if(sheet.rgb.begin(), sheet.rgb.end(), bright), 50) << "words";
}

TEST(SheetOf, NoColumnsIsATitle) {
  const Image8 sheet = sheet_of({"nothing"}, {}, 2);
  EXPECT_GT(sheet.width, 0);
  EXPECT_EQ(sheet.rgb.size(), std::size_t(sheet.width) * sheet.height * 3);
}

}  // namespace
}  // namespace talisman::sequences
