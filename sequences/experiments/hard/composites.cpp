// SPDX-License-Identifier: Apache-2.0
// The compositor: the slow one for equal bytes, and bilinear filtering and `over` in long double for right ones.
#include <algorithm>
#include <cmath>
#include <limits>

#include "chunker/composite.h"
#include "chunker/reference.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using chunker::Frame;
using chunker::kOne;
using chunker::Linear16;
using chunker::PlacedSprite;
using chunker::Sprite;
using chunker::Texel;
using Exact = long double;

const layers::ivec2 kStackDisplay_px{100, 75};
const layers::vec3 kStackBackdrop{0.25f, 0.5f, 0.75f};

Sprite sprite_from(layers::ivec2 size, const std::function<Texel(int, int)>& texel_at) {
  Sprite sprite(size);
  for (int row = 0; row < sprite.chunks().y; ++row)
    for (int column = 0; column < sprite.chunks().x; ++column) {
      chunker::Chunk chunk;
      for (int i = 0; i < chunker::kChunkSize * chunker::kChunkSize; ++i) {
        const int x = column * chunker::kChunkSize + i % chunker::kChunkSize,
                  y = row * chunker::kChunkSize + i / chunker::kChunkSize;
        if (x < size.x && y < size.y) chunk.texels[i] = texel_at(x, y);
      }
      sprite.store(column, row, chunk);
    }
  return sprite;
}

/// Colours that no neighbour has, partly clear, partly opaque, partly light alone.
Sprite motley(layers::ivec2 size) {
  return sprite_from(size, [](int x, int y) {
    Random random(std::uint64_t(x) * 7919 + y);
    const int kind = (x / 9 + y / 7) % 4;
    if (kind == 0) return Texel{};
    const int alpha = kind == 1 ? 255 : kind == 2 ? random.integer(1, 254) : 0;
    const int most = kind == 3 ? 60 : int(std::sqrt(alpha / 255.0) * 255);
    const auto channel = [&] { return std::uint8_t(random.integer(0, most)); };
    const std::uint8_t r = channel(), g = channel(), b = channel();
    return Texel{r, g, b, std::uint8_t(alpha)};
  });
}

Frame composited_stack(const std::vector<PlacedSprite>& stack) {
  return chunker::composite(stack, kStackDisplay_px, kStackBackdrop).frame;
}

PlacedSprite placed_under(const Sprite& sprite, const dmat3& map) {
  PlacedSprite p;
  p.sprite = &sprite;
  p.screen_from_sprite = map;
  return p;
}

/// A map about the middle of a sprite of 64 × 48, to the middle of the display.
dmat3 about_middle(double a, double b, double c, double d, double g = 0, double h = 0) {
  dmat3 map = layers::to_mat3({a, b, 0, c, d, 0});
  map[0].z = g;
  map[1].z = h;
  return layers::to_mat3({1, 0, 50.5001, 0, 1, 37.5002}) * map * layers::to_mat3({1, 0, -32, 0, 1, -24});
}

int largest_step(const Frame& a, const Frame& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Linear16 &p = a.pixels[i], &q = b.pixels[i];
    largest = std::max(
        {largest, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), std::abs(p.a - q.a)});
  }
  return largest;
}

/// Against the slow compositor; refused: nothing is shown.
HardOutcome as_the_slow_one(const dmat3& map) {
  const Sprite sprite = motley({64, 48});
  const std::vector<PlacedSprite> stack{placed_under(sprite, map)};
  const Frame frame = composited_stack(stack);
  const int off = largest_step(frame, chunker::reference::composite(stack, kStackDisplay_px, kStackBackdrop));
  return {double(off), frame == composited_stack({})};
}

void add_maps(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, const dmat3& map,
                       bool refused = false) {
    cases.push_back({HardStage::Compositor,
                     name,
                     special,
                     extreme,
                     {0, "of 65,025 steps", "slow compositor", refused},
                     [map] { return as_the_slow_one(map); }});
  };
  const double c = std::cos(1e-9), s = std::sin(1e-9), nan = std::numeric_limits<double>::quiet_NaN();
  add("turned by 1e-9", "less than a weight is fine", 1e9, about_middle(c, -s, s, c));
  add("enlarged 1e6", "one texel is more than the display", 1e6, about_middle(1e6, 0, 0, 1e6));
  add("reduced 1e3", "a sprite of 0.06 px", 1e3, about_middle(1e-3, 0, 0, 1e-3));
  add("1e4 : 1e-2", "stretched along one axis", 1e6, about_middle(1e4, 0, 0, 1e-2));
  add("sheared 1e3", "a sprite as a thread", 1e3, about_middle(1, 1e3, 0, 1));
  add("mirrored", "from the other side", 1, about_middle(-1, 0, 0, 1));
  add("horizon", "the horizon crosses the display", 1, about_middle(1, 0, 0, 1, 0.05, 0.02));
  add("denominators 1 : 1e6", "foreshortened to the end", 1e6, about_middle(1, 0, 0, 1, (1e-6 - 1) / 32, 0));
  add("flat", "a map without area shows nothing", 1, about_middle(1, 2, 2, 4), true);
  add("not a number", "a map without a meaning shows nothing", 1, about_middle(nan, 0, 0, 1), true);
  add("reduced 1e12", "smaller than can be sampled: nothing", 1e12, about_middle(1e-12, 0, 0, 1e-12), true);
  add("1e15 px away", "far beyond the display: nothing", 1e15, layers::to_mat3({1, 0, 1e15, 0, 1, -1e15}),
      true);
}

// --- Right in long double

struct ExactPixel {
  Exact r, g, b, a;
};

ExactPixel exact_texel(const Sprite& sprite, int x, int y) {
  const Linear16 t = chunker::decode(sprite.texel(x, y));
  return {Exact(t.r), Exact(t.g), Exact(t.b), Exact(t.a)};
}

/// Bilinear at the image of a pixel's centre; clear beyond the sprite.
ExactPixel bilinear_in_exact(const Sprite& sprite, Exact x, Exact y) {
  const Exact left = std::floor(x - Exact(0.5)), top = std::floor(y - Exact(0.5));
  const Exact u = x - Exact(0.5) - left, v = y - Exact(0.5) - top;
  ExactPixel sum{0, 0, 0, 0};
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      const Exact weight = (i ? u : 1 - u) * (j ? v : 1 - v);
      const ExactPixel t = exact_texel(sprite, int(left) + i, int(top) + j);
      sum = {sum.r + weight * t.r, sum.g + weight * t.g, sum.b + weight * t.b, sum.a + weight * t.a};
    }
  return sum;
}

/// A stack in which all sprites lie under one affine map: the largest error of a channel, in white.
HardOutcome as_in_exact(const std::vector<const Sprite*>& sprites, const layers::Affine2& map,
                        float alpha = 1) {
  std::vector<PlacedSprite> stack;
  for (const Sprite* sprite : sprites) {
    stack.push_back(placed_under(*sprite, layers::to_mat3(map)));
    stack.back().alpha_multiplier = alpha;
  }
  const Frame frame = composited_stack(stack);
  const Exact det = Exact(map.a) * map.d - Exact(map.b) * map.c;
  Exact worst = 0;
  for (int y = 0; y < kStackDisplay_px.y; ++y)
    for (int x = 0; x < kStackDisplay_px.x; ++x) {
      const Exact dx = x + Exact(0.5) - map.tx, dy = y + Exact(0.5) - map.ty;
      ExactPixel c{Exact(kStackBackdrop.x) * kOne, Exact(kStackBackdrop.y) * kOne,
                   Exact(kStackBackdrop.z) * kOne, kOne};
      for (const Sprite* sprite : sprites) {
        const ExactPixel s =
            bilinear_in_exact(*sprite, (map.d * dx - map.b * dy) / det, (map.a * dy - map.c * dx) / det);
        const Exact through = 1 - alpha * s.a / kOne;
        const auto over = [&](Exact front, Exact behind) {
          return std::min(alpha * front + behind * through, Exact(kOne));
        };
        c = {over(s.r, c.r), over(s.g, c.g), over(s.b, c.b), over(s.a, c.a)};
      }
      const Linear16& got = frame.pixels[std::size_t(y) * kStackDisplay_px.x + x];
      for (const Exact off : {got.r - c.r, got.g - c.g, got.b - c.b, got.a - c.a})
        worst = worse(worst, std::fabs(off));
    }
  return {double(worst / kOne), false};
}

/// The same sprite `count` times.
HardOutcome repeated_in_exact(int count, Texel texel) {
  const Sprite sprite = sprite_from({64, 48}, [texel](int, int) { return texel; });
  return as_in_exact(std::vector<const Sprite*>(count, &sprite), {1, 0, 20, 0, 1, 12});
}

HardOutcome in_parts() {
  const Sprite sprite = motley({64, 48});
  std::vector<PlacedSprite> stack;
  for (int i = 0; i < 12; ++i) {
    stack.push_back(placed_under(sprite, about_middle(1 + 0.1 * i, 0.3 * i, -0.1 * i, 1)));
    stack.back().alpha_multiplier = 1 - 0.05f * float(i);
  }
  const Frame whole = composited_stack(stack);
  Frame parts = composited_stack({stack.begin(), stack.begin() + 5});
  chunker::composite_onto(parts, std::span(stack).subspan(5, 1));
  chunker::composite_onto(parts, std::span(stack).subspan(6));
  return {double(largest_step(whole, parts)), false};
}

void add_exact(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, double most,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Compositor,
                     name,
                     special,
                     extreme,
                     {most, "of white", "long double"},
                     std::move(measure)});
  };
  constexpr double kRounding = 1.0 / kOne,
                   kWeight = 1.0 / 256;  // weights are rounded to 256ths on either axis
  static const Sprite sprite = motley({64, 48});
  const auto one = [&](const char* name, const char* special, double extreme, double most,
                       const layers::Affine2& map, float alpha = 1) {
    add(name, special, extreme, most, [map, alpha] { return as_in_exact({&sprite}, map, alpha); });
  };
  one("whole pixels", "texel on pixel", 1, 2 * kRounding, {1, 0, 20, 0, 1, 12});
  one("turned", "no weight is a 256th", 1, kWeight, {0.6, -0.8, 50, 0.8, 0.6, 10});
  one("enlarged 1e4, exact", "one texel is 1e4 px", 1e4, kWeight, {1e4, 0, -3.2e5, 0, 1e4, -2.4e5});
  one("a third of a texel", "weights that are no 256ths", 1, kWeight,
      {1, 0, 20 + 1 / 3.0, 0, 1, 12 + 1 / 7.0});
  one("multiplier 1e-3", "a sprite that has nearly faded", 1e3, 2 * kRounding, {1, 0, 20, 0, 1, 12}, 1e-3f);
  add("300 layers of alpha 1/255", "rounding adds up", 300, 300 * 0.5 * kRounding, [] {
    return repeated_in_exact(300, {12, 9, 3, 1});
  });
  add("300 lights", "light on light, beyond white", 300, 2 * kRounding, [] {
    return repeated_in_exact(300, {40, 20, 10, 0});
  });
  cases.push_back({HardStage::Compositor,
                   "in parts",
                   "12 sprites in three calls",
                   1,
                   {0, "of 65,025 steps", "all at once"},
                   in_parts});
}

}  // namespace

std::vector<HardCase> hard_composites() {
  std::vector<HardCase> cases;
  add_maps(cases);
  add_exact(cases);
  return cases;
}

}  // namespace talisman::sequences
