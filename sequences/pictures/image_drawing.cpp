// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/image_drawing.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "sequences/pictures/bitmap_font.h"

namespace talisman::sequences {
namespace {

using layers::ivec2;

constexpr Rgb kPaper{28, 30, 36};  ///< where a magnified picture has no pixels

std::size_t offset_of(const Image8& image, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * image.width + x);
}

void set_pixel(Image8& image, int x, int y, const std::uint8_t* rgb) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy_n(rgb, 3, image.rgb.begin() + offset_of(image, x, y));
}

}  // namespace

Image8 plain_image(int width, int height, Rgb color) {
  Image8 image{width, height, {}};
  image.rgb.reserve(offset_of(image, 0, height));
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  return image;
}

void draw_text(Image8& image, const std::string& text, ivec2 at, Rgb color, int scale) {
  const std::vector<Glyph> glyphs = glyphs_of(text);
  for (std::size_t i = 0; i < glyphs.size(); ++i)
    for (int y = 0; y < kGlyphHeight * scale; ++y)
      for (int x = 0; x < kGlyphWidth * scale; ++x)
        if (glyphs[i][y / scale] >> (kGlyphWidth - 1 - x / scale) & 1)
          set_pixel(image, at.x + static_cast<int>(i) * kGlyphAdvance * scale + x, at.y + y, color.data());
}

void paste(Image8& image, const Image8& picture, ivec2 at) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      set_pixel(image, at.x + x, at.y + y, picture.rgb.data() + offset_of(picture, x, y));
}

Image8 magnified(const Image8& image, ivec2 center, ivec2 size_px, int scale) {
  TALISMAN_CHECK_GE(scale, 1);
  const auto first = [scale](int middle, int shown, int all) {
    return std::clamp(middle - shown / scale / 2, 0, std::max(all - (shown + scale - 1) / scale, 0));
  };
  const ivec2 corner{first(center.x, size_px.x, image.width), first(center.y, size_px.y, image.height)};
  Image8 part = plain_image(size_px.x, size_px.y, kPaper);
  for (int y = 0; y < size_px.y; ++y)
    for (int x = 0; x < size_px.x; ++x) {
      const ivec2 from{corner.x + x / scale, corner.y + y / scale};
      if (from.x < image.width && from.y < image.height)
        set_pixel(part, x, y, image.rgb.data() + offset_of(image, from.x, from.y));
    }
  return part;
}

Rgb signed_color(double share) {
  const double s = std::isfinite(share) ? std::clamp(share, -1.0, 1.0) : 0;
  const auto faded = [](double v) { return static_cast<std::uint8_t>(255 * v + 0.5); };
  const double less = std::fabs(s);
  // The other channels fall first, so that small errors can be seen; then the colour itself darkens a little.
  const double own = 1 - 0.25 * less, other = 1 - less;
  return s >= 0 ? Rgb{faded(own), faded(other), faded(other)} : Rgb{faded(other), faded(other), faded(own)};
}

}  // namespace talisman::sequences
