// SPDX-License-Identifier: Apache-2.0
// pixman, the rasteriser below cairo and X: bilinear filter, 32-bit premultiplied. Where a sprite is only moved it
// takes its fast path, without filter.
#include <algorithm>
#include <memory>
#include <vector>

#include <pixman.h>

#include "tests/bench/peers/compositors.h"

namespace talisman::bench {
namespace {

using Image = std::shared_ptr<pixman_image_t>;

Image image_over(std::uint32_t* argb, layers::ivec2 size) {
  return {pixman_image_create_bits(PIXMAN_a8r8g8b8, size.x, size.y, argb, size.x * 4),
          [](pixman_image_t* image) { pixman_image_unref(image); }};
}

/// pixman reads the texels through a pointer that could write.
Image sprite_image(const Picture& picture, const layers::Affine2& sprite_from_screen) {
  Image image = image_over(const_cast<std::uint32_t*>(picture.argb.data()), picture.size_px);
  const layers::Affine2& m = sprite_from_screen;
  const double rows[3][3] = {{m.a, m.b, m.tx}, {m.c, m.d, m.ty}, {0, 0, 1}};
  pixman_transform_t transform;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) transform.matrix[i][j] = pixman_double_to_fixed(rows[i][j]);
  pixman_image_set_transform(image.get(), &transform);
  pixman_image_set_filter(image.get(), PIXMAN_FILTER_BILINEAR, nullptr, 0);
  pixman_image_set_repeat(image.get(), PIXMAN_REPEAT_NONE);
  return image;
}

}  // namespace

std::function<void()> pixman_compositor(const SpriteStack& stack, ArgbFrame& frame) {
  std::vector<Image> images;
  for (std::size_t i = 0; i < stack.pictures.size(); ++i)
    images.push_back(sprite_image(stack.pictures[i], layers::inverse(stack.screen_from_sprite[i]).value()));
  const Image target = image_over(frame.data(), kDisplay);
  return [&stack, &frame, images, target] {
    std::fill(frame.begin(), frame.end(), kBackgroundArgb);
    for (std::size_t i = 0; i < images.size(); ++i) {
      const layers::RectI r = bounds_px(stack, i);
      if (r.empty()) continue;
      pixman_image_composite32(PIXMAN_OP_OVER, images[i].get(), nullptr, target.get(), r.x0, r.y0, 0, 0, r.x0,
                               r.y0, r.width(), r.height());
    }
  };
}

}  // namespace talisman::bench
