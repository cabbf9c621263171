// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/image_drawing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "layers/check.h"
#include "sequences/pictures/image_view.h"

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::ivec2;

constexpr Rgb kPaper{28, 30, 36};  ///< where a magnified picture has no pixels
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kThickness = 2;     ///< thinner lines of OpenCV fade at the border of the picture
constexpr int kFractionBits = 6;  ///< of the places of lines: 1/64 px

cv::Scalar scalar(Rgb color) { return {double(color[0]), double(color[1]), double(color[2])}; }

double font_scale(int scale) { return scale <= 1 ? 0.38 : 0.3 * scale; }

/// OpenCV would draw a question mark for every byte. The middle dot is a blank here, and its place.
struct PlainText {
  std::string letters;
  std::vector<std::size_t> dots;  ///< indices of the blanks that stand for one
};

PlainText ascii(const std::string& text) {
  PlainText plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (text.compare(i, 2, "·") == 0) {
      plain.dots.push_back(plain.letters.size());
      plain.letters += ' ';
      continue;
    }
    if (byte >= 0x20 && byte < 0x7f) plain.letters += text[i];
    if (byte < 0x20 || byte >= 0xc0) plain.letters += '?';  // bytes from 0x80 on continue a sign
  }
  return plain;
}

struct TextBox {
  int width, above, below;
};

TextBox box_of(const std::string& plain, int scale) {
  int below = 0;
  const cv::Size size = cv::getTextSize(plain, kFont, font_scale(scale), 1, &below);
  return {size.width, size.height, below};
}

cv::Rect inside(const cv::Rect& rect, const Image8& image) {
  return rect & cv::Rect(0, 0, image.width, image.height);
}

}  // namespace

Image8 plain_image(int width, int height, Rgb color) {
  Image8 image{width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height)};
  view_of(image) = scalar(color);
  return image;
}

ivec2 text_size(const std::string& text, int scale) {
  const TextBox box = box_of(ascii(text).letters, scale);
  return {box.width, box.above + box.below};
}

void draw_text(Image8& image, const std::string& text, ivec2 at, Rgb color, int scale) {
  if (image.rgb.empty()) return;
  const PlainText plain = ascii(text);
  const int baseline = at.y + box_of(plain.letters, scale).above;
  cv::putText(view_of(image), plain.letters, {at.x, baseline}, kFont, font_scale(scale), scalar(color), 1,
              cv::LINE_AA);
  for (const std::size_t dot : plain.dots) {
    const int before = box_of(plain.letters.substr(0, dot), scale).width,
              after = box_of(plain.letters.substr(0, dot + 1), scale).width;
    tint(image, {at.x + (before + after) / 2 - 1, baseline - 4 * scale, 2, 2}, color, 1);
  }
}

void draw_line(Image8& image, dvec2 from, dvec2 to, Rgb color) {
  if (image.rgb.empty()) return;
  const auto fixed_point = [](dvec2 p) {  // OpenCV counts from the centre of the first pixel
    return cv::Point(static_cast<int>(std::lround((p.x - 0.5) * (1 << kFractionBits))),
                     static_cast<int>(std::lround((p.y - 0.5) * (1 << kFractionBits))));
  };
  const std::vector<cv::Point> ends{fixed_point(from), fixed_point(to)};
  cv::polylines(view_of(image), ends, false, scalar(color), kThickness, cv::LINE_AA, kFractionBits);
}

void tint(Image8& image, const Crop& where, Rgb color, double share) {
  const cv::Rect rect = inside({where.x, where.y, where.width, where.height}, image);
  if (rect.empty()) return;
  cv::Mat part = view_of(image)(rect);
  cv::addWeighted(part, 1 - share, cv::Mat(rect.size(), CV_8UC3, scalar(color)), share, 0, part);
}

void paste(Image8& image, const Image8& picture, ivec2 at) {
  const cv::Rect rect = inside({at.x, at.y, picture.width, picture.height}, image);
  if (rect.empty()) return;
  view_of(picture)(rect - cv::Point(at.x, at.y)).copyTo(view_of(image)(rect));
}

Image8 cropped(const Image8& image, const Crop& crop) {
  Image8 part = plain_image(crop.width, crop.height, {});
  paste(part, image, {-crop.x, -crop.y});
  return part;
}

Image8 enlarged(const Image8& image, int scale) {
  TALISMAN_CHECK_GE(scale, 1);
  Image8 large = plain_image(image.width * scale, image.height * scale, {});
  if (large.rgb.empty()) return large;
  cv::Mat into = view_of(large);
  cv::resize(view_of(image), into, into.size(), 0, 0, cv::INTER_NEAREST_EXACT);
  return large;
}

Image8 magnified(const Image8& image, ivec2 center, ivec2 size_px, int scale) {
  TALISMAN_CHECK_GE(scale, 1);
  const auto first = [scale](int middle, int shown, int all) {
    return std::clamp(middle - shown / scale / 2, 0, std::max(all - (shown + scale - 1) / scale, 0));
  };
  Crop crop{first(center.x, size_px.x, image.width), first(center.y, size_px.y, image.height), 0, 0};
  crop.width = std::min(image.width - crop.x, (size_px.x + scale - 1) / scale);
  crop.height = std::min(image.height - crop.y, (size_px.y + scale - 1) / scale);
  Image8 part = plain_image(size_px.x, size_px.y, kPaper);
  paste(part, enlarged(cropped(image, crop), scale), {0, 0});
  return part;
}

Image8 difference(const Image8& a, const Image8& b, int gain) {
  TALISMAN_CHECK(a.width == b.width && a.height == b.height);
  Image8 result = plain_image(a.width, a.height, {});
  cv::Mat into = view_of(result);
  cv::absdiff(view_of(a), view_of(b), into);
  into.convertTo(into, CV_8U, gain);
  return result;
}

int largest_difference(const Image8& a, const Image8& b) {
  TALISMAN_CHECK(a.width == b.width && a.height == b.height);
  return static_cast<int>(cv::norm(view_of(a), view_of(b), cv::NORM_INF));
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
