// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/popping.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::ivec2;

bool is_finite(const dmat3& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

struct PixelRect {
  ivec2 lo, hi;  ///< hi exclusive
};

/// The pixels that the sprite's rectangle can reach; all of the display where a corner is behind the horizon.
PixelRect reach_of(const ShownSprite& sprite, ivec2 display_px) {
  dvec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
  const dvec2 size(sprite.size_px);
  for (const dvec2 corner : {dvec2(0, 0), dvec2(size.x, 0), dvec2(0, size.y), size}) {
    const dvec3 p = sprite.screen_from_sprite * dvec3(corner, 1);
    if (!(p.z > 0)) return {{0, 0}, display_px};
    const dvec2 at = dvec2(p) / p.z;
    lo = glm::min(lo, at), hi = glm::max(hi, at);
  }
  const dvec2 display(display_px);
  return {ivec2(glm::floor(glm::clamp(lo, dvec2(0), display))),
          ivec2(glm::ceil(glm::clamp(hi, dvec2(0), display)))};
}

/// Does the sprite hold anything at the homogeneous sprite point q?
bool holds_something(const chunker::Sprite& picture, const dvec3& q) {
  const dvec2 size(picture.size_px());
  const bool inside = q.z > 0 && q.x >= 0 && q.x < size.x * q.z && q.y >= 0 && q.y < size.y * q.z;
  if (!inside) return false;
  return picture.texel(static_cast<int>(q.x / q.z), static_cast<int>(q.y / q.z)) != chunker::Texel{};
}

void mark(PixelMask& mask, const ShownSprite& sprite, const chunker::Sprite& picture, ivec2 display_px) {
  const double det = glm::determinant(sprite.screen_from_sprite);
  if (!is_finite(sprite.screen_from_sprite) || !std::isfinite(det) || det == 0) return;  // shows nothing
  const dmat3 sprite_from_screen = glm::inverse(sprite.screen_from_sprite);
  if (!is_finite(sprite_from_screen)) return;
  const PixelRect reach = reach_of(sprite, display_px);
  for (int y = reach.lo.y; y < reach.hi.y; ++y) {
    std::uint8_t* row = mask.data() + static_cast<std::size_t>(y) * display_px.x;
    for (int x = reach.lo.x; x < reach.hi.x; ++x)
      if (!row[x]) row[x] = holds_something(picture, sprite_from_screen * dvec3(x + 0.5, y + 0.5, 1));
  }
}

}  // namespace

PixelMask stepping_pixels(std::span<const int> shown_before, const FrameReport& now,
                          const chunker::SpriteStore& sprites, ivec2 display_px) {
  PixelMask mask(static_cast<std::size_t>(display_px.x) * display_px.y, 0);
  for (const ShownSprite& sprite : now.shown) {
    const bool drawn_again = sprite.steps && std::find(shown_before.begin(), shown_before.end(),
                                                       sprite.layer) != shown_before.end();
    const chunker::Sprite* picture = drawn_again ? sprites.find(sprite.layer) : nullptr;
    if (picture) mark(mask, sprite, *picture, display_px);
  }
  return mask;
}

double PoppingMeter::Sums::rms() const {
  return pixels > 0 ? std::sqrt(static_cast<double>(squares) / (3.0 * static_cast<double>(pixels))) : 0;
}

void PoppingMeter::add(const ConsecutiveFrames& shown, const ConsecutiveFrames& reference,
                       const PixelMask& stepping) {
  for (const Image8* image : {&shown.before, &shown.now, &reference.before, &reference.now})
    TALISMAN_CHECK_EQ(image->rgb.size(), stepping.size() * 3);
  bool steps = false;
  for (std::size_t pixel = 0; pixel < stepping.size(); ++pixel) {
    int largest = 0, squares = 0;
    for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
      const int error_now = int{shown.now.rgb[c]} - int{reference.now.rgb[c]};
      const int error_before = int{shown.before.rgb[c]} - int{reference.before.rgb[c]};
      const int step = std::abs(error_now - error_before);
      squares += step * step;
      largest = std::max(largest, step);
    }
    Sums& sums = stepping[pixel] ? stepping_ : elsewhere_;
    ++sums.pixels;
    sums.squares += squares;
    if (!stepping[pixel]) continue;
    ++steps_[largest];
    steps = true;
  }
  ++frames_;
  frames_with_steps_ += steps;
}

Popping PoppingMeter::result() const {
  Popping popping{stepping_.rms(), 0, elsewhere_.rms(), 0, frames_, frames_with_steps_};
  const std::int64_t all = stepping_.pixels + elsewhere_.pixels;
  if (all > 0) popping.stepping_share = static_cast<double>(stepping_.pixels) / static_cast<double>(all);
  std::int64_t below = 0;
  for (int step = 0; step <= kLargestStep && 20 * below < 19 * stepping_.pixels; ++step) {
    below += steps_[step];
    popping.p95 = step;
  }
  if (stepping_.pixels == 0) popping.rms = popping.p95 = NAN;  // nothing was seen, which is not: no step
  return popping;
}

}  // namespace talisman::sequences
