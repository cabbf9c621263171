// SPDX-License-Identifier: Apache-2.0
#include "chunker/texture.h"

#include "chunker/pixel.h"

namespace talisman::chunker {
namespace {

Float4 decoded_color(const std::uint8_t* byte) {
  const float alpha = static_cast<float>(byte[3]) / 255.0f;
  return Float4{linear_from_srgb(byte[0]), linear_from_srgb(byte[1]), linear_from_srgb(byte[2]), 1} *
         splat(alpha);
}

Float4 decoded_normal(const std::uint8_t* byte) {
  const auto component = [](std::uint8_t b) { return static_cast<float>(2 * b - 255) / 255.0f; };
  return Float4{component(byte[0]), component(byte[1]), component(byte[2]), 1};
}

template <Float4 (*kDecode)(const std::uint8_t*)>
MipLevel decode_texels(const layers::Texture& texture) {
  MipLevel level{texture.width, texture.height, {}, texture.wrap_u, texture.wrap_v};
  level.texels.resize(static_cast<std::size_t>(texture.width) * texture.height);
  const std::uint8_t* byte = texture.rgba.data();
  for (Float4& texel : level.texels) {
    texel = kDecode(byte);
    byte += 4;
  }
  return level;
}

/// The source texels under one texel of a shorter axis, and how much of the first and last of them: a box of
/// length from/to.
struct Box {
  int first, last;
  float first_share, last_share;
};

std::vector<Box> boxes(int from, int to) {
  std::vector<Box> result(to);
  for (int i = 0; i < to; ++i) {
    // In units of 1/to source texels everything is an integer.
    const std::int64_t lo = static_cast<std::int64_t>(i) * from, hi = lo + from;
    Box& box = result[i];
    box.first = static_cast<int>(lo / to);
    box.last = static_cast<int>((hi - 1) / to);
    box.first_share =
        static_cast<float>((box.first + 1) * static_cast<std::int64_t>(to) - lo) / static_cast<float>(to);
    box.last_share =
        static_cast<float>(hi - box.last * static_cast<std::int64_t>(to)) / static_cast<float>(to);
    if (box.first == box.last)
      box.first_share = box.last_share = static_cast<float>(from) / static_cast<float>(to);
  }
  return result;
}

Float4 box_sum(const Float4* texels, std::size_t stride, const Box& box) {
  Float4 sum = texels[box.first * stride] * splat(box.first_share);
  for (int i = box.first + 1; i < box.last; ++i) sum += texels[i * stride];
  if (box.last > box.first) sum += texels[box.last * stride] * splat(box.last_share);
  return sum;
}

MipLevel half_of(const MipLevel& fine) {
  MipLevel coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}, fine.wrap_u, fine.wrap_v};
  const auto columns = boxes(fine.width, coarse.width), rows = boxes(fine.height, coarse.height);
  std::vector<Float4> narrow(static_cast<std::size_t>(coarse.width) * fine.height);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < coarse.width; ++x)
      narrow[static_cast<std::size_t>(y) * coarse.width + x] =
          box_sum(fine.texels.data() + static_cast<std::size_t>(y) * fine.width, 1, columns[x]);
  const float area = (static_cast<float>(fine.width) / static_cast<float>(coarse.width)) *
                     (static_cast<float>(fine.height) / static_cast<float>(coarse.height));
  coarse.texels.resize(static_cast<std::size_t>(coarse.width) * coarse.height);
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x)
      coarse.texels[static_cast<std::size_t>(y) * coarse.width + x] =
          box_sum(narrow.data() + x, coarse.width, rows[y]) * splat(1 / area);
  return coarse;
}

/// A box of ones sums to one only up to rounding, but what is opaque must stay exactly opaque at every level.
void snap_opaque(MipLevel& level) {
  for (Float4& texel : level.texels)
    if (texel[3] > 1 - 1e-5f) texel[3] = 1;
}

}  // namespace

std::int64_t Pyramid::bytes() const {
  std::int64_t sum = 0;
  for (const MipLevel& level : levels) sum += static_cast<std::int64_t>(level.texels.size() * sizeof(Float4));
  return sum;
}

Float4 as_texture_says(const Pyramid& pyramid, float u, float v, float footprint) {
  const bool minified = footprint > 1;
  const auto look_up = [&](int level) {
    const MipLevel& texels = pyramid.levels[static_cast<std::size_t>(level)];
    return (minified ? pyramid.nearest_minified : pyramid.nearest) ? nearest(texels, u, v)
                                                                   : bilinear(texels, u, v);
  };
  if (!minified || pyramid.finest) return look_up(0);
  const int last = static_cast<int>(pyramid.levels.size()) - 1;
  const float lambda = std::min(0.5f * layers::coarse_log2(footprint), static_cast<float>(last));
  if (pyramid.one_level) return look_up(static_cast<int>(std::ceil(lambda + 0.5f)) - 1);
  const int whole = static_cast<int>(lambda);
  return mix(look_up(whole), look_up(std::min(whole + 1, last)), lambda - static_cast<float>(whole));
}

Float4 anisotropic(const Pyramid& pyramid, float u, float v, const TextureDerivatives& derivatives,
                   int max_samples, int& samples) {
  const float xx = squared_length2(derivatives.x), yy = squared_length2(derivatives.y);
  const Float4 along = xx < yy ? derivatives.y : derivatives.x;
  const float major = std::max(xx, yy), minor = std::max(std::min(xx, yy), 1.0f);
  constexpr float kLargest = 1e12f;  // texels²; beyond it the position of a sample means nothing
  int count = 1;
  if (major > minor && major < kLargest) {
    const float ratio = std::sqrt(major / minor);
    const int whole = static_cast<int>(ratio);
    count = std::min(max_samples, whole + (static_cast<float>(whole) < ratio ? 1 : 0));
  }
  samples += count;
  if (count == 1) return trilinear(pyramid, u, v, major);
  const float share = 1 / static_cast<float>(count), footprint = major * (share * share);
  const float du = along[0] / static_cast<float>(pyramid.levels[0].width),
              dv = along[1] / static_cast<float>(pyramid.levels[0].height);
  Float4 sum = splat(0);
  for (int i = 0; i < count; ++i) {
    const float place = (static_cast<float>(i) + 0.5f) * share - 0.5f;
    sum += trilinear(pyramid, u + du * place, v + dv * place, footprint);
  }
  Float4 mean = sum * splat(share);
  if (mean[3] > 1 - 1e-5f) mean[3] = 1;  // opaque stays exactly opaque
  return mean;
}

namespace {

template <Float4 (*kDecode)(const std::uint8_t*)>
Pyramid decoded_pyramid(const layers::Texture& texture, bool coarser) {
  Pyramid pyramid;
  if (texture.width <= 0 || texture.height <= 0) return pyramid;
  if (texture.rgba.size() < static_cast<std::size_t>(texture.width) * texture.height * 4) return pyramid;
  pyramid.nearest = texture.nearest;
  pyramid.nearest_minified = texture.nearest_minified;
  pyramid.finest = texture.finest;
  pyramid.one_level = texture.one_level;
  pyramid.levels.push_back(decode_texels<kDecode>(texture));
  const auto& finest = pyramid.levels[0].texels;
  pyramid.opaque = std::all_of(finest.begin(), finest.end(), [](const Float4& t) { return t[3] == 1; });
  while (coarser && (pyramid.levels.back().width > 1 || pyramid.levels.back().height > 1)) {
    pyramid.levels.push_back(half_of(pyramid.levels.back()));
    snap_opaque(pyramid.levels.back());
  }
  for (const MipLevel& level : pyramid.levels) {
    pyramid.widths.push_back(level.width);
    pyramid.heights.push_back(level.height);
  }
  return pyramid;
}

}  // namespace

Pyramid build_pyramid(const layers::Texture& texture, bool coarser) {
  return decoded_pyramid<decoded_color>(texture, coarser);
}

Pyramid build_normal_pyramid(const layers::Texture& texture, bool coarser) {
  return decoded_pyramid<decoded_normal>(texture, coarser);
}

}  // namespace talisman::chunker
