// SPDX-License-Identifier: Apache-2.0
#include "sequences/quality.h"

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
  const std::uint8_t* rgb = image.rgb.data();
  for (float& y : luma.values) {
    y = 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
    rgb += 3;
  }
  return luma;
}

template <typename Combine>
Plane combined(const Plane& a, const Plane& b, Combine combine) {
  Plane out(a.width, a.height);
  std::transform(a.values.begin(), a.values.end(), b.values.begin(), out.values.begin(), combine);
  return out;
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
  constexpr float kC1 = 0.01f * 255 * 0.01f * 255, kC2 = 0.03f * 255 * 0.03f * 255;
  const Kernel window = gaussian_kernel(1.5, 5);
  const Plane a = luma_of(test), b = luma_of(reference);
  // Only the sum of the two variances is needed, so both squares share one blur.
  const Plane squares = blur(combined(a, b, [](float x, float y) { return x * x + y * y; }), window);
  const Plane product = blur(combined(a, b, [](float x, float y) { return x * y; }), window);
  const Plane mean_a = blur(a, window), mean_b = blur(b, window);
  Plane similarity(a.width, a.height);
  for (std::size_t i = 0; i < similarity.values.size(); ++i) {
    const float ma = mean_a.values[i], mb = mean_b.values[i];
    const float means = ma * ma + mb * mb, cross = ma * mb;
    const float variances = squares.values[i] - means, covariance = product.values[i] - cross;
    similarity.values[i] = (2 * cross + kC1) * (2 * covariance + kC2) / ((means + kC1) * (variances + kC2));
  }
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
