// SPDX-License-Identifier: Apache-2.0
#include "chunker/reference.h"

#include <algorithm>
#include <optional>

#include "chunker/blend_constants.h"
#include "chunker/sampling.h"

namespace talisman::chunker::reference {
namespace {

/// The position at which pixel (x, y) samples the sprite, if it shows any of it.
std::optional<TapPosition> position_at(const TapMap& map, int x, int y, layers::ivec2 size) {
  if (map.perspective) return perspective_tap(map, x, y, size);
  const int run_x = x / kRunPixels * kRunPixels;
  const auto start = run_start(map, run_x, y);
  if (!start) return std::nullopt;
  const TapPosition p{start->x + (x - run_x) * map.step_x, start->y + (x - run_x) * map.step_y};
  if (!touches(p, size)) return std::nullopt;
  return p;
}

std::uint32_t lerp(std::uint32_t a, std::uint32_t b, std::uint32_t weight) {
  return (a * (256 - weight) + b * weight + 128) >> 8;
}

/// round(v · m / kOne)
std::uint32_t scale(std::uint32_t v, std::uint32_t m) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(v) * m + kOne / 2) / kOne);
}

Linear16 each_channel(const Linear16& a, const Linear16& b, auto&& f) {
  const auto call = [&](std::uint16_t x, std::uint16_t y) { return static_cast<std::uint16_t>(f(x, y)); };
  return {call(a.r, b.r), call(a.g, b.g), call(a.b, b.b), call(a.a, b.a)};
}

Linear16 sample(const Sprite& sprite, const TapPosition& p) {
  const int x = tap_texel(p.x), y = tap_texel(p.y);
  const auto across = [&](std::uint32_t a, std::uint32_t b) { return lerp(a, b, tap_weight(p.x)); };
  const auto down = [&](std::uint32_t a, std::uint32_t b) { return lerp(a, b, tap_weight(p.y)); };
  const Linear16 top = each_channel(decode(sprite.texel(x, y)), decode(sprite.texel(x + 1, y)), across);
  const Linear16 bottom =
      each_channel(decode(sprite.texel(x, y + 1)), decode(sprite.texel(x + 1, y + 1)), across);
  return each_channel(top, bottom, down);
}

Linear16 over(const Linear16& source, const Linear16& below) {
  const std::uint32_t through = kOne - source.a;
  return each_channel(
      source, below, [&](std::uint32_t s, std::uint32_t c) { return std::min(s + scale(c, through), kOne); });
}

}  // namespace

Frame composite(std::span<const PlacedSprite> sprites, layers::ivec2 display_px, layers::vec3 background) {
  Frame frame{display_px.x, display_px.y, {}};
  frame.pixels.assign(static_cast<std::size_t>(display_px.x) * display_px.y, fixed_background(background));
  for (const PlacedSprite& placed : sprites) {
    const auto map = tap_map(placed.screen_from_sprite);
    if (!map) continue;
    const Multiplier multiplier = fixed_multiplier(placed.color_multiplier, placed.alpha_multiplier);
    for (int y = 0; y < display_px.y; ++y) {
      for (int x = 0; x < display_px.x; ++x) {
        const auto position = position_at(*map, x, y, placed.sprite->size_px());
        if (!position) continue;
        Linear16& pixel = frame.pixels[static_cast<std::size_t>(y) * display_px.x + x];
        pixel = over(each_channel(sample(*placed.sprite, *position), multiplier.m, scale), pixel);
      }
    }
  }
  return frame;
}

}  // namespace talisman::chunker::reference
