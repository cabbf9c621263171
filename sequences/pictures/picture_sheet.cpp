// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/picture_sheet.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "layers/check.h"
#include "sequences/pictures/image_view.h"

namespace talisman::sequences {
namespace {

constexpr int kGapPx = 8, kTextScale = 2, kLinePx = 24;
constexpr Rgb kGround{24, 24, 24}, kInk{235, 235, 235};

int text_width(const std::vector<std::string>& lines) {
  int widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, text_size(line, kTextScale).x);
  return widest;
}

/// Returns where the next line would be.
int draw_lines(Image8& image, const std::vector<std::string>& lines, int left, int top) {
  for (const std::string& line : lines) draw_text(image, line, {left, top}, kInk, kTextScale), top += kLinePx;
  return top;
}

/// Squared differences of all pictures, summed over the rectangle from the origin to each pixel: exact, for
/// sums below 2⁵³.
cv::Mat1d summed_squares(const std::vector<const Image8*>& others, const Image8& truth) {
  cv::Mat squares = cv::Mat::zeros(truth.height, truth.width, CV_64F), sums;
  for (const Image8* other : others) {
    TALISMAN_CHECK(other->width == truth.width && other->height == truth.height);
    cv::Mat3d error;
    cv::absdiff(view_of(*other), view_of(truth), error);
    cv::Mat of_pixels;
    cv::transform(error.mul(error), of_pixels, cv::Matx13d(1, 1, 1));
    squares += of_pixels;
  }
  cv::integral(squares, sums, CV_64F);
  return sums;
}

double over(const cv::Mat1d& sums, const Crop& c) {
  const int right = c.x + c.width, below = c.y + c.height;
  return sums(below, right) - sums(below, c.x) - sums(c.y, right) + sums(c.y, c.x);
}

/// The same for all columns.
struct SheetLayout {
  int column_width = 0, words = 0, picture_height = 0, rows = 0;
};

SheetLayout layout_of(const std::vector<SheetColumn>& columns, int scale) {
  SheetLayout layout;
  for (const SheetColumn& column : columns) {
    layout.column_width = std::max(layout.column_width, text_width(column.words));
    layout.words = std::max(layout.words, static_cast<int>(column.words.size()));
    layout.rows = std::max(layout.rows, static_cast<int>(column.pictures.size()));
    for (const Image8& picture : column.pictures) {
      layout.column_width = std::max(layout.column_width, picture.width * scale);
      layout.picture_height = std::max(layout.picture_height, picture.height * scale);
    }
  }
  return layout;
}

}  // namespace

Crop most_different(const std::vector<const Image8*>& others, const Image8& truth, int width, int height) {
  const cv::Mat1d sums = summed_squares(others, truth);
  Crop best{0, 0, std::min(width, truth.width), std::min(height, truth.height)};
  double most = over(sums, best);
  for (Crop crop = best; crop.y + crop.height <= truth.height; ++crop.y)
    for (crop.x = 0; crop.x + crop.width <= truth.width; ++crop.x)
      if (const double sum = over(sums, crop); sum > most) most = sum, best = crop;
  return best;
}

double squared_difference(const std::vector<const Image8*>& others, const Image8& truth, const Crop& crop) {
  return over(summed_squares(others, truth), crop);
}

Image8 sheet_of(const std::vector<std::string>& title, const std::vector<SheetColumn>& columns, int scale) {
  const SheetLayout layout = layout_of(columns, scale);
  const int body = static_cast<int>(columns.size()) * (layout.column_width + kGapPx);
  const int lines = static_cast<int>(title.size()) + layout.words;
  Image8 sheet =
      plain_image(kGapPx + std::max(body, text_width(title) + kGapPx),
                  2 * kGapPx + lines * kLinePx + layout.rows * (layout.picture_height + kGapPx), kGround);
  const int top = draw_lines(sheet, title, kGapPx, kGapPx);
  int left = kGapPx;
  for (const SheetColumn& column : columns) {
    draw_lines(sheet, column.words, left, top);
    int y = top + layout.words * kLinePx;
    for (const Image8& picture : column.pictures) {
      paste(sheet, enlarged(picture, scale), {left, y});
      y += layout.picture_height + kGapPx;
    }
    left += layout.column_width + kGapPx;
  }
  return sheet;
}

}  // namespace talisman::sequences
