// SPDX-License-Identifier: Apache-2.0
// OpenCV has no over: warpAffine into the sprite's rectangle, then over written plainly, for the compiler to
// vectorise.
#include <algorithm>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/bench/peers/compositors.h"

namespace talisman::bench {
namespace {

void over_row(const std::uint8_t* source, std::uint8_t* below, int pixels) {
  for (int i = 0; i < pixels; ++i) {
    const std::uint32_t through = 255u - source[4 * i + 3];
    for (int c = 0; c < 4; ++c) {
      const std::uint32_t product = below[4 * i + c] * through + 128;
      below[4 * i + c] =
          static_cast<std::uint8_t>(std::min(255u, source[4 * i + c] + ((product + (product >> 8)) >> 8)));
    }
  }
}

/// OpenCV's pixel centres are at whole numbers.
cv::Matx23d opencv_map(const layers::Affine2& m, const layers::RectI& rect) {
  return {m.a, m.b, m.tx + 0.5 * (m.a + m.b) - 0.5 - rect.x0,
          m.c, m.d, m.ty + 0.5 * (m.c + m.d) - 0.5 - rect.y0};
}

}  // namespace

std::function<void()> opencv_compositor(const SpriteStack& stack, ArgbFrame& frame) {
  std::vector<cv::Mat> pictures;
  for (const Picture& picture : stack.pictures)
    pictures.emplace_back(picture.size_px.y, picture.size_px.x, CV_8UC4,
                          const_cast<std::uint32_t*>(picture.argb.data()));
  const cv::Mat warped(kDisplay.y, kDisplay.x, CV_8UC4);
  return [&stack, &frame, pictures, warped] {
    cv::setNumThreads(1);
    std::fill(frame.begin(), frame.end(), kBackgroundArgb);
    auto* const bytes = reinterpret_cast<std::uint8_t*>(frame.data());
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const layers::RectI rect = bounds_px(stack, i);
      if (rect.empty()) continue;
      cv::Mat target = warped(cv::Rect(0, 0, rect.width(), rect.height()));
      cv::warpAffine(pictures[i], target, opencv_map(stack.screen_from_sprite[i], rect), target.size(),
                     cv::INTER_LINEAR, cv::BORDER_CONSTANT);
      for (int y = 0; y < rect.height(); ++y)
        over_row(target.ptr(y), bytes + 4 * (static_cast<std::size_t>(rect.y0 + y) * kDisplay.x + rect.x0),
                 rect.width());
    }
  };
}

}  // namespace talisman::bench
