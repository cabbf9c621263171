// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/sprite_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace talisman::bench {
namespace {

using chunker::kChunkSize;
using chunker::Texel;

Texel shaded(double u, double v, bool translucent) {
  const double edge = (1 - std::pow(std::abs(u), 6) - std::pow(std::abs(v), 6)) * 6;
  const double alpha = std::clamp(edge, 0.0, 1.0) * (translucent ? 0.5 : 1);
  const auto channel = [&](double c) { return static_cast<float>(alpha * c); };
  return chunker::encode(
      {channel(0.5 + 0.5 * u), channel(0.5 + 0.5 * v), channel(0.5 + 0.4 * std::sin(9 * u)), channel(1)});
}

/// Square roots can exceed alpha, which 8-bit over does not allow for; peers get the same bytes but for that.
std::uint32_t packed(Texel t) {
  const auto at_most_alpha = [&](std::uint8_t c) { return static_cast<std::uint32_t>(std::min(c, t.a)); };
  return static_cast<std::uint32_t>(t.a) << 24 | at_most_alpha(t.r) << 16 | at_most_alpha(t.g) << 8 |
         at_most_alpha(t.b);
}

/// Texel (x, y) of a sprite goes to both representations. The outermost texels are clear, so that nothing
/// depends on what a library does at a picture's border.
void add_sprite(SpriteStack& stack, layers::ivec2 size, bool translucent) {
  chunker::Sprite sprite(size);
  Picture picture{size, std::vector<std::uint32_t>(static_cast<std::size_t>(size.x) * size.y)};
  for (int row = 0; row < sprite.chunks().y; ++row) {
    for (int column = 0; column < sprite.chunks().x; ++column) {
      chunker::Chunk chunk;
      for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
        const int x = column * kChunkSize + i % kChunkSize, y = row * kChunkSize + i / kChunkSize;
        if (x < 1 || y < 1 || x >= size.x - 1 || y >= size.y - 1) continue;
        const Texel t = shaded(2 * (x + 0.5) / size.x - 1, 2 * (y + 0.5) / size.y - 1, translucent);
        chunk.texels[i] = t;
        picture.argb[static_cast<std::size_t>(y) * size.x + x] = packed(t);
      }
      sprite.store(column, row, chunk);
    }
  }
  stack.sprites.push_back(std::move(sprite));
  stack.pictures.push_back(std::move(picture));
}

/// One sprite over the picture in double precision; outside of it everything is clear.
void lay_exactly(const Picture& picture, const layers::Affine2& sprite_from_screen, const layers::RectI& rect,
                 std::vector<double>& below) {
  const auto texel = [&](int x, int y, int c) {
    if (x < 0 || y < 0 || x >= picture.size_px.x || y >= picture.size_px.y) return 0.0;
    return static_cast<double>(picture.argb[static_cast<std::size_t>(y) * picture.size_px.x + x] >> (8 * c) &
                               255);
  };
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const layers::dvec2 p = sprite_from_screen({x + 0.5, y + 0.5}) - 0.5;
      const int i = static_cast<int>(std::floor(p.x)), j = static_cast<int>(std::floor(p.y));
      const double wx = p.x - i, wy = p.y - j;
      std::array<double, 4> s{};
      for (int c = 0; c < 4; ++c)
        s[c] = (texel(i, j, c) * (1 - wx) + texel(i + 1, j, c) * wx) * (1 - wy) +
               (texel(i, j + 1, c) * (1 - wx) + texel(i + 1, j + 1, c) * wx) * wy;
      double* pixel = &below[4 * (static_cast<std::size_t>(y) * kDisplay.x + x)];
      for (int c = 0; c < 4; ++c) pixel[c] = s[c] + pixel[c] * (1 - s[3] / 255);
    }
  }
}

}  // namespace

SpriteStack make_sprite_stack(int count, int displays, bool unwarped) {
  std::mt19937_64 engine(count * 100 + displays);
  std::uniform_real_distribution<double> unit(0, 1);
  SpriteStack stack;
  const double area = static_cast<double>(displays) * kDisplay.x * kDisplay.y / count;
  for (int i = 0; i < count; ++i) {
    const double aspect = std::exp(0.7 * (unit(engine) - 0.5));
    const layers::ivec2 size{std::min(static_cast<int>(std::sqrt(area * aspect)), kDisplay.x),
                             std::min(static_cast<int>(std::sqrt(area / aspect)), kDisplay.y)};
    add_sprite(stack, size, i % 4 == 3);
  }
  for (const chunker::Sprite& sprite : stack.sprites) {
    const double angle = (unit(engine) - 0.5) * 10 * M_PI / 180, scale = 0.9 + 0.2 * unit(engine);
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    const double x = unit(engine) * (kDisplay.x - sprite.size_px().x),
                 y = unit(engine) * (kDisplay.y - sprite.size_px().y);
    stack.screen_from_sprite.push_back(unwarped ? layers::Affine2{1, 0, std::floor(x), 0, 1, std::floor(y)}
                                                : layers::Affine2{c, -s, x, s, c, y});
    chunker::PlacedSprite placed;
    placed.sprite = &sprite;
    placed.screen_from_sprite = layers::to_mat3(stack.screen_from_sprite.back());
    stack.placed.push_back(placed);
  }
  return stack;
}

layers::RectI bounds_px(const SpriteStack& stack, std::size_t i) {
  const layers::ivec2 size = stack.pictures[i].size_px;
  layers::RectD box;
  for (const layers::dvec2 corner :
       {layers::dvec2(0, 0), layers::dvec2(size.x, 0), layers::dvec2(0, size.y), layers::dvec2(size)})
    box.include(stack.screen_from_sprite[i](corner));
  return {std::max(0, static_cast<int>(std::floor(box.lo.x))),
          std::max(0, static_cast<int>(std::floor(box.lo.y))),
          std::min(kDisplay.x, static_cast<int>(std::ceil(box.hi.x))),
          std::min(kDisplay.y, static_cast<int>(std::ceil(box.hi.y)))};
}

std::vector<unsigned char> exact_composite(const SpriteStack& stack) {
  std::vector<double> picture(4 * static_cast<std::size_t>(kDisplay.x) * kDisplay.y);
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = kBackgroundArgb >> (8 * (i % 4)) & 255;
  for (std::size_t i = 0; i < stack.pictures.size(); ++i)
    lay_exactly(stack.pictures[i], layers::inverse(stack.screen_from_sprite[i]).value(), bounds_px(stack, i),
                picture);
  std::vector<unsigned char> bytes(picture.size());
  for (std::size_t i = 0; i < picture.size(); ++i)
    bytes[i] = static_cast<unsigned char>(std::min(255.0, picture[i] + 0.5));
  return bytes;
}

std::vector<unsigned char> bytes_of(const std::vector<std::uint32_t>& argb) {
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * argb.size());
  for (const std::uint32_t pixel : argb)
    for (int c = 0; c < 4; ++c) bytes.push_back(static_cast<unsigned char>(pixel >> (8 * c) & 255));
  return bytes;
}

}  // namespace talisman::bench
