// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/quality.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

Plane luma_of(const Image8& image) {
  Plane luma(image.width, image.height);
  for_each_row(image.height, [&](int y) {
    const std::uint8_t* rgb = image.rgb.data() + static_cast<std::size_t>(y) * image.width * 3;
    float* out = luma.row(y);
    for (int x = 0; x < image.width; ++x, rgb += 3)
      out[x] = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
  });
  return luma;
}

template <typename Combine>
Plane combined(const Plane& a, const Plane& b, Combine combine) {
  Plane out(a.width, a.height);
  for_each_row(a.height,
               [&](int y) { std::transform(a.row(y), a.row(y) + a.width, b.row(y), out.row(y), combine); });
  return out;
}

struct LocalMoments {
  Plane mean_a, mean_b;
  Plane squares;  ///< blurred a² + b²: only the sum of the two variances is needed
  Plane product;  ///< blurred a b
};

LocalMoments local_moments(const Plane& a, const Plane& b) {
  const Kernel window = gaussian_kernel(1.5, 5);
  return {blur(a, window), blur(b, window),
          blur(combined(a, b, [](float x, float y) { return x * x + y * y; }), window),
          blur(combined(a, b, [](float x, float y) { return x * y; }), window)};
}

void similarity_row(const LocalMoments& m, int y, float* out) {
  constexpr float kC1 = 0.01f * 255 * 0.01f * 255, kC2 = 0.03f * 255 * 0.03f * 255;
  const float *a = m.mean_a.row(y), *b = m.mean_b.row(y), *squares = m.squares.row(y),
              *product = m.product.row(y);
  for (int x = 0; x < m.mean_a.width; ++x) {
    const float means = a[x] * a[x] + b[x] * b[x], cross = a[x] * b[x];
    const float variances = squares[x] - means, covariance = product[x] - cross;
    out[x] = (2 * cross + kC1) * (2 * covariance + kC2) / ((means + kC1) * (variances + kC2));
  }
}

/// PSNR, largest difference and share of changed pixels, in exact integers.
void measure_differences(const Image8& test, const Image8& reference, Quality& quality) {
  std::int64_t squares = 0, changed = 0;
  for (std::size_t i = 0; i < test.rgb.size(); i += 3) {
    int largest = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const int d = std::abs(int{test.rgb[c]} - int{reference.rgb[c]});
      squares += d * d;
      largest = std::max(largest, d);
    }
    quality.max_difference = std::max(quality.max_difference, largest);
    changed += largest > 0;
  }
  quality.psnr_db = std::numeric_limits<double>::infinity();
  if (squares == 0) return;
  const double samples = static_cast<double>(test.rgb.size());
  quality.psnr_db = 10 * std::log10(255.0 * 255.0 * samples / static_cast<double>(squares));
  quality.changed_pixels = static_cast<double>(changed) / (samples / 3);
}

void check_comparable(const Image8& test, const Image8& reference) {
  TALISMAN_CHECK_EQ(test.width, reference.width);
  TALISMAN_CHECK_EQ(test.height, reference.height);
  TALISMAN_CHECK_EQ(test.rgb.size(), static_cast<std::size_t>(test.width) * test.height * 3);
  TALISMAN_CHECK_EQ(test.rgb.size(), reference.rgb.size());
}

}  // namespace

double mean(const std::vector<float>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double ssim(const Image8& test, const Image8& reference) {
  check_comparable(test, reference);
  if (test.rgb.empty()) return 1;
  const LocalMoments moments = local_moments(luma_of(test), luma_of(reference));
  Plane similarity(test.width, test.height);
  for_each_row(test.height, [&](int y) { similarity_row(moments, y, similarity.row(y)); });
  return mean(similarity.values);
}

Quality compare(const Image8& test, const Image8& reference, const QualityOptions& options) {
  check_comparable(test, reference);
  Quality quality;
  measure_differences(test, reference, quality);
  if (quality.max_difference == 0) return quality;  // exactly 1 and 0, without rounding
  if (options.ssim) quality.ssim = ssim(test, reference);
  if (options.flip) quality.flip = mean(flip_map(test, reference, options.pixels_per_degree));
  return quality;
}

}  // namespace talisman::sequences
