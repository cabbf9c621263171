// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/apparent_shift.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

constexpr int kBorder_px = 8;
constexpr int kIterations = 4;
constexpr float kLongestStep_px = 1.5f;
/// ε, in shares of the structure that counts and of that which is there: along a strong edge what the window
/// seems to say of the motion is rounding and resampling.
constexpr float kFlatRidge = 0.5f * static_cast<float>(kStructure * kStructure), kEdgeRidge = 0.05f;
constexpr float kSeen = 0.05f, kSolid = 0.5f, kNothing = 0.25f;  ///< of alpha

/// Linear, premultiplied, with alpha.
cv::Mat4f linear_of(const chunker::Frame& frame, const Crop& crop) {
  constexpr float kScale = 1.0f / static_cast<float>(chunker::kOne);
  cv::Mat4f image(crop.height, crop.width);
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) {
      const chunker::Linear16& p =
          frame.pixels[static_cast<std::size_t>(y + crop.y) * static_cast<std::size_t>(frame.width) +
                       static_cast<std::size_t>(x + crop.x)];
      image(y, x) = {p.r * kScale, p.g * kScale, p.b * kScale, p.a * kScale};
    }
  return image;
}

/// As the eye weighs it: the square root of the colours; and soft, since the gradient of a hard edge says
/// nothing of a displacement longer than the edge is wide.
cv::Mat4f perceived(const cv::Mat4f& linear) {
  constexpr double kSoft_px = 1.2;
  cv::Mat4f image = linear.clone();
  for (cv::Vec4f& p : image)
    for (int k = 0; k < 3; ++k) p[k] = std::sqrt(std::max(p[k], 0.0f));
  cv::GaussianBlur(image, image, {}, kSoft_px, kSoft_px, cv::BORDER_REPLICATE);
  return image;
}

Crop seen_in(const chunker::Frame& shown, const chunker::Frame& fresh) {
  int left = fresh.width, right = -1, top = fresh.height, bottom = -1;
  for (int y = 0; y < fresh.height; ++y)
    for (int x = 0; x < fresh.width; ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(fresh.width) + static_cast<std::size_t>(x);
      if (shown.pixels[i].a == 0 && fresh.pixels[i].a == 0) continue;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = y;
    }
  if (right < 0) return {};
  left = std::max(left - kBorder_px, 0), top = std::max(top - kBorder_px, 0);
  right = std::min(right + kBorder_px, fresh.width - 1),
  bottom = std::min(bottom + kBorder_px, fresh.height - 1);
  return {left, top, right - left + 1, bottom - top + 1};
}

cv::Mat1f summed(const cv::Mat4f& a, const cv::Mat4f& b) {
  cv::Mat1f sum(a.size());
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(), [](const cv::Vec4f& p, const cv::Vec4f& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  });
  cv::GaussianBlur(sum, sum, {}, kWindow_px, kWindow_px, cv::BORDER_REPLICATE);
  return sum;
}

/// The picture at x + d.
template <typename Image>
Image displaced(const Image& image, const cv::Mat2f& shift) {
  cv::Mat2f at(shift.size());
  for (int y = 0; y < at.rows; ++y)
    for (int x = 0; x < at.cols; ++x)
      at(y, x) = {static_cast<float>(x) + shift(y, x)[0], static_cast<float>(y) + shift(y, x)[1]};
  Image result;
  cv::remap(image, result, at, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

/// The gradients of the fresh picture at one level, and their products over the window.
struct Gradients {
  cv::Mat4f x, y;
  cv::Mat1f xx, xy, yy;

  explicit Gradients(const cv::Mat4f& image) {
    constexpr double kScharr = 1.0 / 32;
    cv::Scharr(image, x, CV_32F, 1, 0, kScharr, 0, cv::BORDER_REPLICATE);
    cv::Scharr(image, y, CV_32F, 0, 1, kScharr, 0, cv::BORDER_REPLICATE);
    xx = summed(x, x), xy = summed(x, y), yy = summed(y, y);
  }
};

void refine(const cv::Mat4f& shown, const cv::Mat4f& fresh, const Gradients& g, cv::Mat2f& shift) {
  for (int k = 0; k < kIterations; ++k) {
    const cv::Mat4f error = displaced(shown, shift) - fresh;
    const cv::Mat1f ex = summed(g.x, error), ey = summed(g.y, error);
    for (int y = 0; y < shift.rows; ++y)
      for (int x = 0; x < shift.cols; ++x) {
        const float ridge = kFlatRidge + kEdgeRidge * (g.xx(y, x) + g.yy(y, x));
        const float a = g.xx(y, x) + ridge, b = g.xy(y, x), c = g.yy(y, x) + ridge;
        const float determinant = a * c - b * b;
        const float dx = (c * ex(y, x) - b * ey(y, x)) / determinant;
        const float dy = (a * ey(y, x) - b * ex(y, x)) / determinant;
        shift(y, x) -= cv::Vec2f(std::clamp(dx, -kLongestStep_px, kLongestStep_px),
                                 std::clamp(dy, -kLongestStep_px, kLongestStep_px));
      }
  }
}

/// From the coarsest level, at which the known displacement is about a pixel, to the pictures themselves.
cv::Mat2f shift_of(const cv::Mat4f& shown, const cv::Mat4f& fresh, int coarser) {
  constexpr int kSmallest_px = 16;
  cv::Mat2f shift = cv::Mat2f::zeros(fresh.size());
  if (coarser > 0 && std::min(fresh.rows, fresh.cols) >= 2 * kSmallest_px) {
    cv::Mat4f half_shown, half_fresh;
    cv::pyrDown(shown, half_shown);
    cv::pyrDown(fresh, half_fresh);
    const cv::Mat2f half = shift_of(half_shown, half_fresh, coarser - 1);
    cv::resize(half, shift, fresh.size(), 0, 0, cv::INTER_LINEAR);
    shift *= 2;
  }
  refine(shown, fresh, Gradients(fresh), shift);
  return shift;
}

/// Both pictures, once as the eye weighs them and once in linear light, blurred since resampling blurs.
struct Compared {
  cv::Mat4f eye_shown, eye_fresh, shown, fresh;
};

cv::Mat4f blurred(const cv::Mat4f& linear) {
  cv::Mat4f image;
  cv::GaussianBlur(linear, image, {}, 1, 1, cv::BORDER_REPLICATE);
  return image;
}

/// ‖shown - fresh‖² of the colours.
cv::Mat1f color_squares(const cv::Mat4f& shown, const cv::Mat4f& fresh) {
  cv::Mat1f squares(fresh.size());
  std::transform(shown.begin(), shown.end(), fresh.begin(), squares.begin(),
                 [](const cv::Vec4f& p, const cv::Vec4f& q) {
                   const cv::Vec4f d = p - q;
                   return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                 });
  return squares;
}

/// The means over the window that a displacement leaves.
struct Left {
  cv::Mat1f all;     ///< of the squares, as the eye weighs them, with alpha
  cv::Mat1f colors;  ///< of the squares of the colours in linear light
  cv::Mat1f cover;   ///< of the squares of alpha
};

Left left_by(const Compared& pictures, const cv::Mat2f& shift) {
  const cv::Mat4f error = displaced(pictures.eye_shown, shift) - pictures.eye_fresh;
  Left left{summed(error, error), color_squares(displaced(pictures.shown, shift), pictures.fresh),
            cv::Mat1f(error.size())};
  std::transform(error.begin(), error.end(), left.cover.begin(),
                 [](const cv::Vec4f& e) { return e[3] * e[3]; });
  for (cv::Mat1f* mean : {&left.colors, &left.cover})
    cv::GaussianBlur(*mean, *mean, {}, kWindow_px, kWindow_px, cv::BORDER_REPLICATE);
  return left;
}

/// Where a part of a displacement does as well, but for what nobody sees, it is that part; and where the light that
/// is known to change is enough.
void shorten_where_less_will_do(const Compared& pictures, double light, cv::Mat2f& shift) {
  constexpr float kUnseen = 1.0f / 255, kAsWell = 1.1f;
  const auto as_well = [](float with, float least) { return with <= kAsWell * least + kUnseen * kUnseen; };
  const auto announced = static_cast<float>(light * light);
  const Left least = left_by(pictures, shift);
  cv::Mat2f shortest = shift.clone();
  for (const double part : {0.75, 0.5, 0.25, 0.0}) {
    const cv::Mat2f shorter = shift * part;
    const Left with = left_by(pictures, shorter);
    for (int y = 0; y < shift.rows; ++y)
      for (int x = 0; x < shift.cols; ++x)
        if (as_well(with.all(y, x), least.all(y, x)) ||
            (with.colors(y, x) <= announced && as_well(with.cover(y, x), least.cover(y, x))))
          shortest(y, x) = shorter(y, x);
  }
  shift = shortest;
}

int levels_for(double explained_px) {
  constexpr double kSearched_px = 4, kPerLevel_px = 1.5;
  const double reach = std::min(std::max(2 * explained_px, kSearched_px), 64.0);
  return static_cast<int>(std::ceil(std::log2(reach / kPerLevel_px)));
}

void measure_shift(const cv::Mat4f& fresh, const cv::Mat2f& shift, ApparentShift& result) {
  const Gradients g(fresh);
  std::vector<float> lengths;
  double sum = 0;
  for (int y = 0; y < shift.rows; ++y)
    for (int x = 0; x < shift.cols; ++x) {
      if (fresh(y, x)[3] < kSeen || g.xx(y, x) + g.yy(y, x) < kStructure * kStructure) continue;
      lengths.push_back(std::hypot(shift(y, x)[0], shift(y, x)[1]));
      sum += lengths.back();
    }
  result.structured_px = static_cast<long>(lengths.size());
  if (lengths.empty()) return;
  const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(lengths.size() - 1));
  std::nth_element(lengths.begin(), lengths.begin() + rank, lengths.end());
  result.p95_px = lengths[static_cast<std::size_t>(rank)];
  result.mean_px = sum / static_cast<double>(lengths.size());
}

void shorten(double longest, cv::Mat2f& shift) {
  for (cv::Vec2f& d : shift) {
    const double length = std::hypot(d[0], d[1]);
    if (length > longest) d *= static_cast<float>(longest / length);
  }
}

/// Beside the displacement that was found: of a structure finer than the window no one displacement is right.
constexpr double kBeside_px = 1;

/// The least of ‖shown - fresh‖² over the displacements `within` and those about kBeside_px beside them, none longer than
/// `longest_px`. `carried`: shown, displaced by `within`.
cv::Mat1f least_squares(const cv::Mat4f& shown, const cv::Mat4f& fresh, const cv::Mat2f& within,
                        const cv::Mat4f& carried, double longest_px) {
  cv::Mat1f least = color_squares(carried, fresh);
  const auto beside = static_cast<float>(std::min(kBeside_px, longest_px));
  if (beside == 0) return least;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const float share = beside / std::hypot(static_cast<float>(dx), static_cast<float>(dy));
      cv::Mat2f near = within + cv::Scalar(share * static_cast<float>(dx), share * static_cast<float>(dy));
      shorten(longest_px, near);
      least = cv::min(least, color_squares(displaced(shown, near), fresh));
    }
  return least;
}

void measure_rest(const Compared& pictures, cv::Mat2f shift, double explained_px, ApparentShift& result) {
  const cv::Mat4f &shown = pictures.shown, &fresh = pictures.fresh;
  shorten(explained_px, shift);
  const cv::Mat4f carried = displaced(shown, shift);
  const cv::Mat1f rest = least_squares(shown, fresh, shift, carried, explained_px);
  double squares = 0;
  long seen = 0, solid = 0, missing = 0;
  for (int y = 0; y < fresh.rows; ++y)
    for (int x = 0; x < fresh.cols; ++x) {
      const float of_shown = carried(y, x)[3], of_fresh = fresh(y, x)[3];
      solid += of_fresh > kSolid;
      missing += of_fresh > kSolid && of_shown < kNothing;
      if (of_shown < kSeen && of_fresh < kSeen) continue;
      squares += static_cast<double>(rest(y, x));
      ++seen;
    }
  if (seen > 0) result.rms = std::sqrt(squares / static_cast<double>(seen));
  if (solid > 0) result.missing = static_cast<double>(missing) / static_cast<double>(solid);
}

}  // namespace

ApparentShift apparent_shift(const chunker::Frame& shown, const chunker::Frame& fresh,
                             const ExplainedChange& explained) {
  TALISMAN_CHECK(shown.width == fresh.width && shown.height == fresh.height);
  ApparentShift result;
  result.seen = seen_in(shown, fresh);
  if (result.seen.width == 0) return result;
  const cv::Mat4f linear_shown = linear_of(shown, result.seen), linear_fresh = linear_of(fresh, result.seen);
  const Compared pictures{perceived(linear_shown), perceived(linear_fresh), blurred(linear_shown),
                          blurred(linear_fresh)};
  cv::Mat2f shift = shift_of(pictures.eye_shown, pictures.eye_fresh, levels_for(explained.shift_px));
  shorten_where_less_will_do(pictures, explained.light, shift);
  measure_shift(pictures.eye_fresh, shift, result);
  measure_rest(pictures, shift, explained.shift_px, result);
  return result;
}

}  // namespace talisman::sequences
