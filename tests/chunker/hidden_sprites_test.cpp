// SPDX-License-Identifier: Apache-2.0
/// What an opaque sprite hides is left out, and nobody can tell: the oracle composites all of it. The
/// counters' oracle composites every sprite alone, where nothing is hidden.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "chunker/composite.h"
#include "chunker/span_composite.h"
#include "chunker/tile_reach.h"
#include "chunker/window.h"
#include "tests/chunker/composite_fixtures.h"

namespace talisman::chunker {
namespace {

constexpr ivec2 kScreen{150, 110};  // the last tiles of a line and the last band are cut
constexpr layers::vec3 kBehind{0.2f, 0.4f, 0.6f};

CompositeCounters counted_alone(std::span<const PlacedSprite> stack, ivec2 display) {
  CompositeCounters sum;
  for (const PlacedSprite& sprite : stack) sum += composite({&sprite, 1}, display, kBehind).counters;
  EXPECT_EQ(sum.pixels_hidden, 0);
  return sum;
}

/// Composites a stack and compares bytes and counters with the oracles.
CompositeCounters expect_as_if_all_were_drawn(std::span<const PlacedSprite> stack, ivec2 display = kScreen) {
  const CompositeResult result = composite(stack, display, kBehind);
  EXPECT_EQ(difference(result.frame, reference::composite(stack, display, kBehind)), "");
  EXPECT_EQ(of_the_model(result.counters), counted_alone(stack, display));
  return result.counters;
}

Sprite opaque_noise(Random& random, ivec2 size) {
  return make_sprite(size, [&](int, int) { return Texel{random.byte(), random.byte(), random.byte(), 255}; });
}

/// Maps of every family, some of which mirror or nearly collapse, about the middle of a sprite of `size` and
/// near the middle of the screen.
dmat3 any_map(Random& random, ivec2 size) {
  const double mirror = random.chance(0.3) ? -1 : 1, angle = random.real(-3.2, 3.2);
  const double c = std::cos(angle), s = std::sin(angle);
  const double tiny = random.chance(0.5) ? 1e-3 : 1e-9;
  const double x = random.real(30, 120), y = random.real(20, 90);
  const dmat3 centre = translation(-size.x / 2.0, -size.y / 2.0);
  dmat3 perspective = affine(c, -s, x, s, c, y);
  perspective[0][2] = random.real(-4e-3, 4e-3);
  perspective[1][2] = random.real(-4e-3, 4e-3);
  const dmat3 maps[] = {
      translation(std::floor(x), std::floor(y)),
      translation(x, y),
      affine(mirror * random.real(0.3, 3), 0, x, 0, random.real(0.3, 3), y),
      affine(mirror, 0, std::floor(x), 0, 1, std::floor(y)),
      affine(mirror * c, -s, x, mirror * s, c, y),
      affine(random.real(-2, 2), random.real(-2, 2), x, random.real(-2, 2), random.real(-2, 2), y),
      affine(1, 1, x, 1, 1 + tiny, y),
      affine(0, 1, std::floor(x), -1, 0, std::floor(y)),
      perspective,
  };
  return maps[random.integer(0, 8)] * centre;
}

TEST(HiddenSprites, OpaqueStackIsDrawnOnce) {
  Random random(11);
  std::vector<Sprite> sprites;
  for (int i = 0; i < 12; ++i) sprites.push_back(opaque_noise(random, {256, 256}));
  std::vector<PlacedSprite> stack;
  for (const Sprite& sprite : sprites) {
    const double angle = random.real(-0.1, 0.1), c = std::cos(angle), s = std::sin(angle);
    stack.push_back(placed(sprite, affine(c, -s, -50, s, c, -50)));
  }
  const CompositeCounters counters = expect_as_if_all_were_drawn(stack);
  EXPECT_EQ(counters.pixels_composited, 12 * kScreen.x * kScreen.y);
  EXPECT_EQ(counters.pixels_hidden, 11 * kScreen.x * kScreen.y);
}

TEST(HiddenSprites, TransparentStackHidesNothing) {
  const Sprite clear({256, 256}), faint = solid({256, 256}, {0, 0, 0, 1}),
                                  light = solid({256, 256}, {9, 9, 9, 0});
  std::vector<PlacedSprite> stack;
  for (int i = 0; i < 9; ++i) {
    const Sprite& sprite = i % 3 == 0 ? clear : i % 3 == 1 ? faint : light;
    stack.push_back(placed(sprite, translation(-50.25, -50.5)));
  }
  EXPECT_EQ(expect_as_if_all_were_drawn(stack).pixels_hidden, 0);
}

// A clear sprite below an opaque one was never read: it is skipped as clear, not hidden.
TEST(HiddenSprites, ClearOnesCountAsClear) {
  const Sprite clear({256, 256}), front = solid({256, 256}, {1, 2, 3, 255});
  const PlacedSprite stack[] = {placed(clear, translation(-50, -50)), placed(front, translation(-50, -50))};
  const CompositeCounters counters = expect_as_if_all_were_drawn(stack);
  EXPECT_EQ(counters.pixels_hidden, 0);
  EXPECT_GT(counters.chunks_skipped_clear, 0);
}

TEST(HiddenSprites, TenThousandOfOnePixel) {
  Random random(12);
  const Sprite opaque = solid({1, 1}, {250, 9, 90, 255}), half = solid({1, 1}, {90, 9, 9, 128});
  const Sprite ground = opaque_noise(random, {200, 200});
  std::vector<PlacedSprite> stack;
  for (int i = 0; i < 10000; ++i) {
    const Sprite& sprite = i == 5000 ? ground : i % 2 ? opaque : half;
    const bool lattice = random.chance(0.3);
    const double x = random.real(-2, 151), y = random.real(-2, 111);
    stack.push_back(placed(sprite, lattice ? translation(std::floor(x), std::floor(y)) : translation(x, y)));
    if (i == 5000) stack.back().screen_from_sprite = translation(-20.5, -30.25);
  }
  const CompositeResult result = composite(stack, kScreen, kBehind);
  EXPECT_EQ(difference(result.frame, reference::composite(stack, kScreen, kBehind)), "");
  EXPECT_GT(result.counters.pixels_hidden, 4000);
  // One pixel at a time the counters are those of each alone.
  EXPECT_EQ(of_the_model(result.counters), counted_alone(stack, kScreen));
}

// Opaque sprites with one texel that is not quite, next to borders of chunks and of blocks, under maps that put
// it at and just beyond the border of a tile: the first texel that is wrongly taken for opaque shows.
TEST(HiddenSprites, OneTexelThatIsNotOpaqueShows) {
  Random random(13);
  const Sprite below = opaque_noise(random, {300, 300});
  const std::array<double, 5> fractions{0, 1.0 / 512, 1.0 / 256, 0.5, 255.0 / 256};
  int hidden = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const int border = 8 * random.integer(1, 15);
    const ivec2 hole{border + random.integer(-2, 1), random.integer(0, 127)};
    const bool turned = random.chance(0.5);
    const Sprite front = make_sprite({128, 128}, [&](int x, int y) {
      const bool here = turned ? x == hole.y && y == hole.x : x == hole.x && y == hole.y;
      return Texel{200, 100, 50, static_cast<std::uint8_t>(here ? 0 : 255)};
    });
    const double fx = fractions[random.integer(0, 4)], fy = fractions[random.integer(0, 4)];
    const dmat3 map = random.chance(0.7)
                          ? translation(random.integer(-40, 40) + fx, random.integer(-40, 40) + fy)
                          : any_map(random, front.size_px());
    const PlacedSprite stack[] = {placed(below, translation(-70.5, -70)), placed(front, map)};
    const CompositeResult result = composite(stack, kScreen, kBehind);
    ASSERT_EQ(difference(result.frame, reference::composite(stack, kScreen, kBehind)), "") << trial;
    hidden += result.counters.pixels_hidden > 0;
  }
  EXPECT_GT(hidden, 300);  // or nothing was tested
}

/// Random sprites of opaque, clear, translucent and additive parts; some fade or are tinted.
std::vector<PlacedSprite> random_stack(Random& random, std::span<const Sprite> sprites) {
  std::vector<PlacedSprite> stack;
  for (const Sprite& sprite : sprites) {
    stack.push_back(placed(sprite, any_map(random, sprite.size_px())));
    if (random.chance(0.2)) stack.back().alpha_multiplier = static_cast<float>(random.real(0, 1));
    if (random.chance(0.2)) stack.back().color_multiplier = {1, static_cast<float>(random.real(0, 1)), 1};
  }
  return stack;
}

std::vector<Sprite> mixed_sprites(Random& random) {
  std::vector<Sprite> sprites;
  for (int i = 0; i < 6; ++i) {
    sprites.push_back(random.chance(0.6)
                          ? opaque_noise(random, {random.integer(1, 260), random.integer(1, 260)})
                          : random.sprite(200));
  }
  return sprites;
}

TEST(HiddenSprites, RandomStacksUnderEveryWarpFamily) {
  const std::uint64_t seed = 20261130;
  SCOPED_TRACE(seed);
  Random random(seed);
  std::int64_t hidden = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const std::vector<Sprite> sprites = mixed_sprites(random);
    hidden += expect_as_if_all_were_drawn(random_stack(random, sprites)).pixels_hidden;
    if (HasFailure()) return;
  }
  EXPECT_GT(hidden, 100000);
}

TEST(HiddenSprites, EveryInstructionSetGivesTheSameBytes) {
  Random random(14);
  for (int trial = 0; trial < 10; ++trial) {
    const std::vector<Sprite> sprites = mixed_sprites(random);
    const std::vector<PlacedSprite> stack = random_stack(random, sprites);
    const CompositeResult best = composite(stack, kScreen, kBehind);
    for (const std::int64_t set : instruction_sets()) {
      use_instruction_set(set);
      const CompositeResult other = composite(stack, kScreen, kBehind);
      use_instruction_set(0);
      EXPECT_EQ(difference(other.frame, best.frame), "") << instruction_set_name(set);
      EXPECT_EQ(other.counters, best.counters);
    }
  }
}

// The extended compositor lays single sprites over pictures that are not opaque: there, too, an opaque sprite
// leaves only itself, alpha included.
TEST(HiddenSprites, OverPicturesThatAreNotOpaque) {
  Random random(15);
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<Sprite> sprites = mixed_sprites(random);
    const std::vector<PlacedSprite> stack = random_stack(random, sprites);
    Frame at_once{kScreen.x, kScreen.y, {}};
    for (int i = 0; i < kScreen.x * kScreen.y; ++i)
      at_once.pixels.push_back(decode({random.byte(), random.byte(), random.byte(), random.byte()}));
    Frame one_by_one = at_once;
    composite_onto(at_once, stack);
    for (const PlacedSprite& sprite : stack) composite_onto(one_by_one, {&sprite, 1});
    ASSERT_EQ(difference(at_once, one_by_one), "") << trial;
  }
}

// A multiplier of one in 65,025 less than one is not one.
TEST(HiddenSprites, FadingSpriteHidesNothing) {
  const Sprite below = solid({200, 200}, {255, 255, 255, 255}), front = solid({200, 200}, {0, 0, 0, 255});
  PlacedSprite stack[] = {placed(below, translation(-20, -20)), placed(front, translation(-20, -20))};
  EXPECT_GT(expect_as_if_all_were_drawn(stack).pixels_hidden, 0);
  stack[1].alpha_multiplier = 65024.0f / 65025;
  EXPECT_EQ(expect_as_if_all_were_drawn(stack).pixels_hidden, 0);
}

TEST(WholeTileReach, EqualsThePixelsOneByOne) {
  Random random(16);
  int whole = 0, perspective = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const ivec2 size{random.integer(1, 300), random.integer(1, 300)};
    const auto map = tap_map(any_map(random, size));
    if (!map) continue;
    const int x0 = kRunPixels * random.integer(0, 4), y0 = kBandLines * random.integer(0, 3);
    const layers::RectI tile{x0, y0, x0 + random.integer(1, kRunPixels), y0 + random.integer(1, kBandLines)};
    const auto reach = whole_tile_reach(*map, size, tile);
    TapBounds bounds;
    bool all_touch = true;
    for (int y = tile.y0; y < tile.y1; ++y) {
      const auto start = map->perspective ? std::nullopt : run_start(*map, x0, y);
      for (int x = tile.x0; x < tile.x1; ++x) {
        auto p = map->perspective ? perspective_tap(*map, x, y, size) : start;
        if (p && !map->perspective) p->x += (x - x0) * map->step_x, p->y += (x - x0) * map->step_y;
        all_touch = all_touch && p && touches(*p, size);
        if (p) bounds.include(tap_texel(p->x), tap_texel(p->y));
      }
    }
    ASSERT_TRUE(map->perspective || reach.has_value() == all_touch) << trial;
    if (!reach) continue;
    ASSERT_TRUE(all_touch) << trial;
    const layers::RectI &inner = reach->inner.rect, &outer = reach->outer.rect, &seen = bounds.rect;
    ASSERT_TRUE(outer.x0 <= seen.x0 && outer.y0 <= seen.y0 && outer.x1 >= seen.x1 && outer.y1 >= seen.y1);
    ASSERT_TRUE(inner.x0 >= seen.x0 && inner.y0 >= seen.y0 && inner.x1 <= seen.x1 && inner.y1 <= seen.y1);
    ++whole;
    perspective += map->perspective;
  }
  EXPECT_GT(whole, 2000);
  EXPECT_GT(perspective, 100);
}

// Chunks come, change and go; a chunk that moves into a gap keeps its blocks.
TEST(SpriteOpaqueBlocks, FollowWhatIsStored) {
  Random random(17);
  Sprite sprite({130, 100});
  const layers::RectI all{0, 0, 130, 100};
  for (int step = 0; step < 3000; ++step) {
    const int column = random.integer(0, 3), row = random.integer(0, 2);
    Chunk chunk;
    if (random.chance(0.8)) {
      for (Texel& t : chunk.texels) t = {1, 2, 3, 255};
      for (int i = random.integer(0, 6); i > 0; --i) chunk.texels[random.integer(0, 1023)].a = 254;
    }
    sprite.store(column, row, chunk);
    for (int block = 0; block < 16; ++block) {
      bool opaque = true;
      for (int i = 0; i < 64; ++i)
        opaque &=
            sprite.texel(32 * column + block % 4 * 8 + i % 8, 32 * row + block / 4 * 8 + i / 8).a == 255;
      ASSERT_EQ(sprite.opaque_blocks(column, row) >> block & 1, opaque) << step << ' ' << block;
    }
    // Any rectangle: the blocks that it touches, one texel at a time.
    const int x = random.integer(-3, 129), y = random.integer(-3, 99);
    const layers::RectI rect{x, y, x + random.integer(1, 70), y + random.integer(1, 70)};
    bool opaque = rect.x0 >= all.x0 && rect.y0 >= all.y0 && rect.x1 <= all.x1 && rect.y1 <= all.y1;
    for (int v = rect.y0; opaque && v < rect.y1; ++v)
      for (int u = rect.x0; opaque && u < rect.x1; ++u)
        opaque = sprite.opaque_blocks(u / 32, v / 32) >> (v % 32 / 8 * 4 + u % 32 / 8) & 1;
    ASSERT_EQ(is_opaque(sprite, rect), opaque) << step;
  }
}

}  // namespace
}  // namespace talisman::chunker
