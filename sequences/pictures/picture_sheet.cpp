// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/picture_sheet.h"

#include <algorithm>
#include <cstdlib>

#include "layers/check.h"
#include "sequences/pictures/bitmap_font.h"
#include "sequences/pictures/image_drawing.h"

namespace talisman::sequences {
namespace {

constexpr int kGapPx = 8, kTextScale = 2;
constexpr int kLinePx = (kGlyphHeight + 3) * kTextScale;

std::uint8_t* pixel(Image8& image, int x, int y) {
  return image.rgb.data() + (static_cast<std::size_t>(y) * image.width + x) * 3;
}
const std::uint8_t* pixel(const Image8& image, int x, int y) {
  return image.rgb.data() + (static_cast<std::size_t>(y) * image.width + x) * 3;
}

void fill(Image8& image, const Crop& where, const std::uint8_t* rgb) {
  for (int y = std::max(where.y, 0); y < std::min(where.y + where.height, image.height); ++y)
    for (int x = std::max(where.x, 0); x < std::min(where.x + where.width, image.width); ++x)
      std::copy(rgb, rgb + 3, pixel(image, x, y));
}

int text_width(const std::vector<std::string>& lines) {
  std::size_t longest = 0;
  for (const std::string& line : lines) longest = std::max(longest, glyphs_of(line).size());
  return static_cast<int>(longest) * kGlyphAdvance * kTextScale;
}

int draw_lines(Image8& image, const std::vector<std::string>& lines, int left, int top) {
  constexpr Rgb kInk{235, 235, 235};
  for (const std::string& line : lines) draw_text(image, line, {left, top}, kInk, kTextScale), top += kLinePx;
  return top;
}

void draw_scaled(Image8& image, const Image8& picture, int left, int top, int scale) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      fill(image, {left + x * scale, top + y * scale, scale, scale}, pixel(picture, x, y));
}

/// Squared differences of all pictures, summed over the rectangle from the origin to each pixel.
class SummedSquares {
 public:
  SummedSquares(const std::vector<const Image8*>& others, const Image8& truth)
      : width_(truth.width), sums_(static_cast<std::size_t>(truth.width + 1) * (truth.height + 1), 0) {
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x) {
        std::int64_t here = 0;
        for (const Image8* other : others)
          for (int c = 0; c < 3; ++c) {
            const std::int64_t d = pixel(*other, x, y)[c] - pixel(truth, x, y)[c];
            here += d * d;
          }
        at(x + 1, y + 1) = here + at(x, y + 1) + at(x + 1, y) - at(x, y);
      }
  }
  std::int64_t over(const Crop& c) {
    return at(c.x + c.width, c.y + c.height) - at(c.x, c.y + c.height) - at(c.x + c.width, c.y) +
           at(c.x, c.y);
  }

 private:
  std::int64_t& at(int x, int y) { return sums_[static_cast<std::size_t>(y) * (width_ + 1) + x]; }
  int width_;
  std::vector<std::int64_t> sums_;
};

}  // namespace

Image8 cropped(const Image8& image, const Crop& crop) {
  Image8 part{crop.width, crop.height, std::vector<std::uint8_t>(std::size_t(crop.width) * crop.height * 3)};
  for (int y = 0; y < crop.height; ++y) {
    const std::uint8_t* row = pixel(image, crop.x, crop.y + y);
    std::copy(row, row + std::size_t(crop.width) * 3, pixel(part, 0, y));
  }
  return part;
}

Image8 difference(const Image8& a, const Image8& b, int gain) {
  TALISMAN_CHECK_EQ(a.rgb.size(), b.rgb.size());
  Image8 result = a;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    result.rgb[i] = static_cast<std::uint8_t>(std::min(std::abs(a.rgb[i] - b.rgb[i]) * gain, 255));
  return result;
}

int largest_difference(const Image8& a, const Image8& b) {
  TALISMAN_CHECK_EQ(a.rgb.size(), b.rgb.size());
  int largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) largest = std::max(largest, std::abs(a.rgb[i] - b.rgb[i]));
  return largest;
}

Crop most_different(const std::vector<const Image8*>& others, const Image8& truth, int width, int height) {
  SummedSquares squares(others, truth);
  Crop best{0, 0, std::min(width, truth.width), std::min(height, truth.height)};
  std::int64_t most = squares.over(best);
  for (Crop crop = best; crop.y + crop.height <= truth.height; ++crop.y)
    for (crop.x = 0; crop.x + crop.width <= truth.width; ++crop.x)
      if (const std::int64_t sum = squares.over(crop); sum > most) most = sum, best = crop;
  return best;
}

double squared_difference(const std::vector<const Image8*>& others, const Image8& truth, const Crop& crop) {
  return double(SummedSquares(others, truth).over(crop));
}

Image8 sheet_of(const std::vector<std::string>& title, const std::vector<SheetColumn>& columns, int scale) {
  int column_width = 0, words = 0, picture_height = 0, rows = 0;
  for (const SheetColumn& column : columns) {
    column_width = std::max(column_width, text_width(column.words));
    words = std::max(words, static_cast<int>(column.words.size()));
    rows = std::max(rows, static_cast<int>(column.pictures.size()));
    for (const Image8& picture : column.pictures) {
      column_width = std::max(column_width, picture.width * scale);
      picture_height = std::max(picture_height, picture.height * scale);
    }
  }
  const int body = static_cast<int>(columns.size()) * (column_width + kGapPx);
  Image8 sheet;
  sheet.width = kGapPx + std::max(body, text_width(title) + kGapPx);
  sheet.height =
      2 * kGapPx + (static_cast<int>(title.size()) + words) * kLinePx + rows * (picture_height + kGapPx);
  sheet.rgb.assign(static_cast<std::size_t>(sheet.width) * sheet.height * 3, 24);
  const int top = draw_lines(sheet, title, kGapPx, kGapPx);
  int left = kGapPx;
  for (const SheetColumn& column : columns) {
    draw_lines(sheet, column.words, left, top);
    int y = top + words * kLinePx;
    for (const Image8& picture : column.pictures) {
      draw_scaled(sheet, picture, left, y, scale);
      y += picture_height + kGapPx;
    }
    left += column_width + kGapPx;
  }
  return sheet;
}

}  // namespace talisman::sequences
