// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/gltf_baked_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sequences/import/pbr_surface.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

constexpr double kNoChange = 1.0 / 512;  // half a code value of white

/// A texture looked up at the centres of the texels of a grid of another size, bilinear, ends clamped.
class Resampled {
 public:
  Resampled(const layers::Texture& texture, int width, int height)
      : texture_(texture),
        x_scale_(double(texture.width) / width),
        y_scale_(double(texture.height) / height) {}

  double at(int x, int y, int channel) const {
    if (x_scale_ == 1 && y_scale_ == 1) return texel(x, y, channel);
    const double u = (x + 0.5) * x_scale_ - 0.5, v = (y + 0.5) * y_scale_ - 0.5;
    const int left = static_cast<int>(std::floor(u)), top = static_cast<int>(std::floor(v));
    const double a = u - left, b = v - top;
    return (1 - b) * ((1 - a) * texel(left, top, channel) + a * texel(left + 1, top, channel)) +
           b * ((1 - a) * texel(left, top + 1, channel) + a * texel(left + 1, top + 1, channel));
  }

 private:
  double texel(int x, int y, int channel) const {
    x = std::clamp(x, 0, texture_.width - 1), y = std::clamp(y, 0, texture_.height - 1);
    return texture_.rgba[4 * (static_cast<std::size_t>(y) * texture_.width + x) + channel];
  }
  const layers::Texture& texture_;
  double x_scale_, y_scale_;
};

class Baking {
 public:
  explicit Baking(const MapsToBake& maps) : maps_(maps) {
    for (const layers::Texture* map : {maps.color, maps.metallic, maps.occlusion}) {
      if (!map) continue;
      if (!first_) first_ = map;
      width_ = std::max(width_, map->width), height_ = std::max(height_, map->height);
    }
    for (int byte = 0; byte < 256; ++byte) linear_[byte] = linear_from_srgb(static_cast<float>(byte) / 255);
  }

  layers::Texture baked() const {
    layers::Texture to;
    const std::vector<float> factors = all_factors();
    const bool changes = std::any_of(factors.begin(), factors.end(),
                                     [](float factor) { return std::abs(factor - 1) > kNoChange; });
    if (!changes) return to;
    to = look_of(*first_);
    to.width = width_, to.height = height_;
    to.rgba.reserve(4 * factors.size());
    for (int y = 0, i = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x, ++i) add_texel(x, y, factors[static_cast<std::size_t>(i)], to);
    return to;
  }

 private:
  static layers::Texture look_of(const layers::Texture& from) {
    layers::Texture to;
    to.name = from.name;
    to.wrap_u = from.wrap_u, to.wrap_v = from.wrap_v;
    to.nearest = from.nearest, to.finest = from.finest;
    return to;
  }

  std::vector<float> all_factors() const {
    std::vector<float> factors(static_cast<std::size_t>(width_) * height_,
                               static_cast<float>(pbr_color_share(maps_.metallic_factor)));
    if (maps_.metallic)
      for_each_texel(*maps_.metallic, 2, [&](std::size_t i, double blue) {
        factors[i] = static_cast<float>(pbr_color_share(maps_.metallic_factor * blue));
      });
    if (maps_.occlusion)
      for_each_texel(*maps_.occlusion, 0, [&](std::size_t i, double red) {
        factors[i] *= static_cast<float>(1 - 0.5 * maps_.occlusion_strength * (1 - red));
      });
    return factors;
  }

  template <typename Use>
  void for_each_texel(const layers::Texture& map, int channel, const Use& use) const {
    const Resampled values(map, width_, height_);
    std::size_t i = 0;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) use(i++, values.at(x, y, channel) / 255);
  }

  void add_texel(int x, int y, float factor, layers::Texture& to) const {
    std::array<std::uint8_t, 4> own = {255, 255, 255, 255};
    if (maps_.color) {
      const Resampled color(*maps_.color, width_, height_);
      for (int k = 0; k < 4; ++k) own[k] = static_cast<std::uint8_t>(std::lround(color.at(x, y, k)));
    }
    for (int k = 0; k < 3; ++k) to.rgba.push_back(srgb_byte(linear_[own[k]] * factor));
    to.rgba.push_back(own[3]);
    to.has_alpha |= own[3] < 255;
  }

  const MapsToBake& maps_;
  const layers::Texture* first_ = nullptr;
  int width_ = 0, height_ = 0;
  std::array<float, 256> linear_{};
};

}  // namespace

layers::Texture baked_maps(const MapsToBake& maps) { return Baking(maps).baked(); }

}  // namespace talisman::sequences
