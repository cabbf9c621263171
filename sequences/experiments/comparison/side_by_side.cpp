// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/comparison/side_by_side.h"

#include <cmath>

#include "layers/check.h"
#include "sequences/pictures/image_drawing.h"

namespace talisman::sequences {

namespace {

constexpr Rgb kGround = {24, 24, 24}, kWords = {240, 240, 240};
constexpr int kGap_px = 4;

/// What fits in the width, the rest as "..".
std::string fitting(std::string text, int width_px, int scale) {
  while (text.size() > 2 && text_size(text, scale).x > width_px)
    text = text.substr(0, text.size() - 3) + "..";
  return text;
}

}  // namespace

Image8 side_by_side(const std::vector<const Image8*>& pictures, const std::vector<std::string>& titles) {
  TALISMAN_CHECK_EQ(pictures.size(), titles.size());
  if (pictures.empty()) return {};
  const int count = static_cast<int>(pictures.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  const int width = pictures[0]->width, height = pictures[0]->height;
  constexpr int kLargeFrom_px = 400;
  const int scale = width >= kLargeFrom_px ? 2 : 1, words_px = text_size("X", scale).y + kGap_px;
  Image8 sheet =
      plain_image(columns * (width + kGap_px) + kGap_px, rows * (height + words_px + kGap_px), kGround);
  for (int k = 0; k < count; ++k) {
    const int x = kGap_px + k % columns * (width + kGap_px), y = k / columns * (height + words_px + kGap_px);
    draw_text(sheet, fitting(titles[k], width, scale), {x, y + kGap_px / 2}, kWords, scale);
    paste(sheet, *pictures[k], {x, y + words_px});
  }
  return sheet;
}

}  // namespace talisman::sequences
