// SPDX-License-Identifier: Apache-2.0
#include "chunker/composite.h"

#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "chunker/reference.h"
#include "chunker/span_composite.h"
#include "tests/chunker/composite_fixtures.h"

namespace talisman::chunker {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr Texel kTestTexel{200, 100, 50, 255};

CompositeResult one(const Sprite& sprite, const dmat3& map, ivec2 display = {70, 50}) {
  const PlacedSprite p = placed(sprite, map);
  return composite({&p, 1}, display, {0.25f, 0.5f, 0.75f});
}

Frame background(ivec2 display = {70, 50}) { return composite({}, display, {0.25f, 0.5f, 0.75f}).frame; }

void expect_equals_reference(std::span<const PlacedSprite> sprites, ivec2 display, const std::string& what) {
  const Frame fast = composite(sprites, display, {0.1f, 0.9f, 0}).frame;
  EXPECT_EQ(difference(fast, reference::composite(sprites, display, {0.1f, 0.9f, 0})), "") << what;
}

/// A random map of the kinds that a frame has, and of those it should not have.
dmat3 random_map(Random& random, ivec2 display) {
  const double scale = std::exp(random.real(-1, 1) * (random.chance(0.2) ? 4 : 0.3));
  const double angle = random.chance(0.3) ? 0 : random.real(-3.2, 3.2);
  const double mirror = random.chance(0.1) ? -1 : 1;
  const double c = scale * std::cos(angle), s = scale * std::sin(angle);
  double tx = random.real(-40, display.x), ty = random.real(-40, display.y);
  if (random.chance(0.3)) tx = std::floor(tx), ty = std::floor(ty);
  dmat3 m = affine(c, -s * random.real(0.8, 1.2), tx, s * mirror, c * mirror, ty);
  if (random.chance(0.2)) {
    m[0][2] = random.real(-0.02, 0.02);
    m[1][2] = random.real(-0.02, 0.02);
    m[2][2] = random.chance(0.2) ? random.real(-1, 1) : 1;
  }
  return m;
}

float random_multiplier(Random& random) {
  return random.chance(0.7) ? 1.0f : static_cast<float>(random.real(-0.1, 1.1));
}

struct RandomStack {
  std::vector<Sprite> sprites;
  std::vector<PlacedSprite> placed_sprites;
  ivec2 display{0, 0};

  explicit RandomStack(Random& random) : display{random.integer(1, 75), random.integer(1, 75)} {
    const int count = random.integer(0, 3);
    for (int i = 0; i < count; ++i) sprites.push_back(random.sprite(80));
    for (const Sprite& sprite : sprites) {
      PlacedSprite p = placed(sprite, random_map(random, display));
      if (random.chance(0.3)) {
        p.color_multiplier = {random_multiplier(random), random_multiplier(random),
                              random_multiplier(random)};
        p.alpha_multiplier = random_multiplier(random);
      }
      placed_sprites.push_back(p);
    }
  }
};

// Stacks of up to three sprites of all kinds of chunks under all kinds of maps; displays that are not whole
// tiles.
TEST(Composite, RandomStacksEqualTheReferenceByteForByte) {
  constexpr int kCases = 10000;
  for (int seed = 0; seed < kCases; ++seed) {
    Random random(seed);
    const RandomStack stack(random);
    expect_equals_reference(stack.placed_sprites, stack.display, "seed " + std::to_string(seed));
    if (HasFailure()) return;
  }
}

// Each instruction set is a different compilation of the inner loop with a different vector width.
TEST(Composite, EveryInstructionSetGivesTheSameBytes) {
  ASSERT_GE(instruction_sets().size(), 1u);
  for (const std::int64_t set : instruction_sets()) {
    use_instruction_set(set);
    for (int seed = 20000; seed < 20400 && !HasFailure(); ++seed) {
      Random random(seed);
      const RandomStack stack(random);
      const std::string what = std::string(instruction_set_name(set)) + ", seed " + std::to_string(seed);
      expect_equals_reference(stack.placed_sprites, stack.display, what);
    }
  }
  use_instruction_set(0);
}

TEST(Composite, OneTwoAndThreeThreadsGiveTheSameBytesAndCounters) {
  Random random(7);
  std::vector<Sprite> sprites;
  for (int i = 0; i < 12; ++i) sprites.push_back(random.sprite(300));
  std::vector<PlacedSprite> stack;
  for (const Sprite& sprite : sprites) stack.push_back(placed(sprite, random_map(random, {321, 257})));
  std::vector<CompositeResult> results;
  for (const int threads : {1, 2, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(composite(stack, {321, 257}, {0, 0, 0}));
  }
  for (const CompositeResult& result : results) {
    EXPECT_EQ(difference(result.frame, results[0].frame), "");
    EXPECT_EQ(result.counters, results[0].counters);
  }
  EXPECT_GT(results[0].counters.pixels_composited, 0);
}

TEST(Composite, IntegerTranslationReproducesEveryTexelExactly) {
  Random random(1);
  const ivec2 size{67, 45};
  const Sprite sprite = make_sprite(size, [&](int, int) {
    return Texel{random.byte(), random.byte(), random.byte(), 255};
  });
  for (const ivec2 at : {ivec2{0, 0}, ivec2{-5, 31}, ivec2{32, -1}, ivec2{63, 33}}) {
    const Frame frame = one(sprite, translation(at.x, at.y), {130, 90}).frame;
    const Frame empty = background({130, 90});
    for (int y = 0; y < 90; ++y) {
      for (int x = 0; x < 130; ++x) {
        const bool inside = x >= at.x && y >= at.y && x < at.x + size.x && y < at.y + size.y;
        const Linear16 expected =
            inside ? decode(sprite.texel(x - at.x, y - at.y)) : empty.pixels[y * 130 + x];
        ASSERT_EQ(frame.pixels[y * 130 + x], expected) << x << ' ' << y << " at " << at.x << ' ' << at.y;
      }
    }
  }
}

// The oracle shares no code with the compositor: the inverse is GLM's, positions and filter are in double.
// The bound is what 8-bit weights (1/512 per axis, twice) and positions in fixed point may cost.
TEST(Composite, FilterFollowsTheBilinearFormulaInDouble) {
  Random random(11);
  const Sprite sprite = make_sprite({40, 40}, [&](int x, int y) {
    const auto smooth = [&](double f) {
      return static_cast<std::uint8_t>(120 + 100 * std::sin(f * x) * std::cos(f * y));
    };
    return Texel{smooth(0.1), smooth(0.2), smooth(0.3), 255};
  });
  const dmat3 maps[] = {affine(0.99, -0.1, 8.3, 0.1, 1.02, 5.7), affine(2.7, 0.3, 4.25, -0.2, 3.1, 9.6), [] {
                          dmat3 m = affine(1.1, 0.1, 3.2, -0.05, 0.9, 7.9);
                          m[0][2] = 0.003;
                          m[1][2] = -0.002;
                          return m;
                        }()};
  for (const dmat3& map : maps) {
    const Frame frame = one(sprite, map).frame;
    const dmat3 inverse = glm::inverse(map);
    int compared = 0;
    for (int i = 0; i < 70 * 50; ++i) {
      const layers::dvec3 q = inverse * layers::dvec3(i % 70 + 0.5, i / 70 + 0.5, 1);
      const double x = q.x / q.z - 0.5, y = q.y / q.z - 0.5;
      if (!(x >= 0 && y >= 0 && x < 39 && y < 39)) continue;
      const int ix = static_cast<int>(x), iy = static_cast<int>(y);
      const double wx = x - ix, wy = y - iy;
      const auto at = [&](int dx, int dy) {
        return static_cast<double>(decode(sprite.texel(ix + dx, iy + dy)).r);
      };
      const double expected =
          (1 - wy) * ((1 - wx) * at(0, 0) + wx * at(1, 0)) + wy * ((1 - wx) * at(0, 1) + wx * at(1, 1));
      const double slope =
          std::abs(at(1, 0) - at(0, 0)) + std::abs(at(0, 1) - at(0, 0)) + std::abs(at(1, 1) - at(0, 0));
      ASSERT_NEAR(frame.pixels[i].r, expected, 2 + slope * (1.0 / 512 + 0.0003) * 2) << i;
      ++compared;
    }
    EXPECT_GT(compared, 800);
  }
}

// Texels beyond the rectangle are clear, so that the border fades to the background instead of repeating.
TEST(Composite, HalfTexelShiftHalvesTheBorder) {
  const Sprite white = solid({8, 8}, {255, 255, 255, 255});
  const PlacedSprite p = placed(white, translation(4.5, 4));
  const CompositeResult result = composite({&p, 1}, {20, 20}, {0, 0, 0});
  EXPECT_EQ(result.frame.pixels[6 * 20 + 3].r, 0);
  EXPECT_EQ(result.frame.pixels[6 * 20 + 4].r, 32513);  // round(kOne / 2)
  EXPECT_EQ(result.frame.pixels[6 * 20 + 5].r, kOne);
  EXPECT_EQ(result.frame.pixels[6 * 20 + 12].r, 32513);
  EXPECT_EQ(result.frame.pixels[6 * 20 + 13].r, 0);
  EXPECT_EQ(result.counters.pixels_composited, 9 * 8);
}

TEST(Composite, NoSpritesShowTheBackground) {
  const CompositeResult result = composite({}, {5, 3}, {0, 0.5f, 2});
  ASSERT_EQ(result.frame.pixels.size(), 15u);
  for (const Linear16& p : result.frame.pixels) EXPECT_EQ(p, (Linear16{0, 32513, 65025, 65025}));
  EXPECT_EQ(result.counters, CompositeCounters{});
}

// Frames of a sequence share memory; nothing of the last one may shine through, also when the size changes.
TEST(CompositeInto, UsedFrameGivesTheSameBytesAsAFreshOne) {
  Random random(13);
  const Sprite sprite = random.sprite(90);
  Frame frame;
  for (const ivec2 display : {ivec2{100, 70}, ivec2{100, 70}, ivec2{33, 65}, ivec2{0, 0}, ivec2{120, 90}}) {
    const PlacedSprite p = placed(sprite, random_map(random, {60, 40}));
    const CompositeResult fresh = composite({&p, 1}, display, {0.5f, 0, 0});
    EXPECT_EQ(composite_into(frame, {&p, 1}, display, {0.5f, 0, 0}), fresh.counters);
    EXPECT_EQ(difference(frame, fresh.frame), "");
  }
}

TEST(Composite, BackgroundThatIsNotANumberIsBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(composite({}, {1, 1}, {nan, -1, 0}).frame.pixels[0], (Linear16{0, 0, 0, 65025}));
}

TEST(Composite, EmptyDisplayGivesAnEmptyFrame) {
  const Sprite sprite = solid({4, 4}, kTestTexel);
  EXPECT_TRUE(one(sprite, translation(0, 0), {0, 0}).frame.pixels.empty());
  EXPECT_TRUE(one(sprite, translation(0, 0), {0, 7}).frame.pixels.empty());
}

TEST(Composite, DisplayOfOnePixel) {
  const Sprite sprite = solid({4, 4}, kTestTexel);
  const CompositeResult result = one(sprite, translation(-2, -3), {1, 1});
  EXPECT_EQ(result.frame.pixels[0], decode(kTestTexel));
  EXPECT_EQ(result.counters.pixels_composited, 1);
}

TEST(Composite, EmptySpritesShowNothing) {
  for (const ivec2 size : {ivec2{0, 0}, ivec2{0, 40}, ivec2{40, 0}}) {
    const CompositeResult result = one(Sprite(size), translation(3, 3));
    EXPECT_EQ(difference(result.frame, background()), "");
    EXPECT_EQ(result.counters, CompositeCounters{});
  }
}

// A clear sprite costs no sampling, but its pixels are still inside its rectangle.
TEST(Composite, ClearChunksAreSkippedAndCounted) {
  const CompositeResult result = one(Sprite({64, 64}), translation(0, 0), {64, 64});
  EXPECT_EQ(difference(result.frame, background({64, 64})), "");
  EXPECT_EQ(result.counters.pixels_composited, 64 * 64);
  EXPECT_EQ(result.counters.chunks_skipped_clear, 64 * 2);
  EXPECT_EQ(result.counters.sprite_bands, 2);
}

TEST(Composite, SingularAndNonFiniteMapsShowNothing) {
  const Sprite sprite = solid({16, 16}, kTestTexel);
  dmat3 singular_perspective = affine(1, 2, 3, 2, 4, 6);
  singular_perspective[0][2] = 0.1;
  dmat3 nan_perspective = translation(0, 0);
  nan_perspective[1][2] = kNaN;
  const dmat3 maps[] = {dmat3(0.0),
                        affine(1, 2, 0, 2, 4, 0),
                        affine(0, 0, 5, 0, 1, 5),
                        affine(kNaN, 0, 0, 0, 1, 0),
                        translation(kInf, 0),
                        translation(0, kNaN),
                        affine(1e-200, 0, 0, 0, 1e-200, 0),
                        affine(1e300, 0, 0, 0, 1e300, 0),
                        singular_perspective,
                        nan_perspective};
  for (const dmat3& map : maps) {
    const CompositeResult result = one(sprite, map);
    EXPECT_EQ(difference(result.frame, background()), "");
    EXPECT_EQ(result.counters.pixels_composited, 0);
  }
}

// Positions of 1e9 pixels do not fit 16.16; they must not come back around by overflow.
TEST(Composite, FarOffTheDisplayShowsNothing) {
  const Sprite sprite = solid({64, 64}, kTestTexel);
  for (const double far : {70.0, 2e4, 65536.0, 1e9, 4294967296.0, 1e15, 1e90}) {
    for (const dmat3& map : {translation(far, 0), translation(-far - 64, 3), translation(1, far),
                             translation(1, -far - 64), affine(0.9, 0.1, far, -0.1, 0.9, -far - 200)}) {
      const CompositeResult result = one(sprite, map);
      EXPECT_EQ(difference(result.frame, background()), "") << far;
      EXPECT_EQ(result.counters.pixels_composited, 0) << far;
    }
  }
}

// One texel covers the display a hundred times; every pixel lies inside it.
TEST(Composite, MagnifiedAMillionTimes) {
  const Sprite sprite = solid({3, 3}, kTestTexel);
  const Frame frame = one(sprite, affine(1e6, 0, -1.5e6, 0, 1e6, -1.5e6)).frame;
  for (const Linear16& p : frame.pixels) ASSERT_EQ(p, decode(kTestTexel));
  const PlacedSprite p = placed(sprite, affine(1e6, 1e5, -1.5e6, -1e5, 1e6, -1.5e6));
  expect_equals_reference({&p, 1}, {70, 50}, "magnified and turned");
}

// 64 texels in 0.05 pixels: seen only when a pixel centre falls on it, and then as one bilinear sample of the
// middle.
TEST(Composite, MinifiedBelowAPixel) {
  const Sprite sprite = solid({64, 64}, kTestTexel);
  const double s = 0.05 / 64;
  const CompositeResult hit = one(sprite, affine(s, 0, 33.48, 0, s, 20.48));
  EXPECT_EQ(hit.counters.pixels_composited, 1);
  EXPECT_EQ(hit.frame.pixels[20 * 70 + 33], decode(kTestTexel));
  const CompositeResult miss = one(sprite, affine(s, 0, 33.9, 0, s, 20.9));
  EXPECT_EQ(difference(miss.frame, background()), "");
  for (const double tiny : {1e-3, 1e-6, 1e-9}) {
    const PlacedSprite p =
        placed(sprite, affine(tiny, -tiny / 3, 35.5 - 32 * tiny, tiny / 3, tiny, 25.5 - 32 * tiny));
    expect_equals_reference({&p, 1}, {70, 50}, std::to_string(tiny));
  }
}

// Minified four- to fortyfold the tile's texels do not fit the window, and footprints come straight from the
// chunks.
TEST(Composite, StronglyMinifiedEqualsTheReference) {
  Random random(3);
  const Sprite sprite = make_sprite({1500, 900}, [&](int, int) {
    return Texel{random.byte(), 9, 7, random.byte()};
  });
  for (const double scale : {0.5, 0.4, 0.25, 0.11, 0.025}) {
    const PlacedSprite p = placed(sprite, affine(scale, -scale / 7, 3.3, scale / 9, scale, 4.1));
    expect_equals_reference({&p, 1}, {130, 100}, std::to_string(scale));
    PlacedSprite tilted = p;
    tilted.screen_from_sprite[0][2] = 1e-3;
    expect_equals_reference({&tilted, 1}, {130, 100}, "tilted " + std::to_string(scale));
  }
}

// The denominator falls to zero inside the sprite: what lies beyond the horizon must not appear mirrored.
TEST(Composite, HorizonThroughTheSprite) {
  const Sprite sprite = solid({64, 64}, kTestTexel);
  dmat3 map = affine(1, 0, 0, 0, 1, 10);
  map[1][2] = -1.0 / 32;  // zero at q.y = 32; screen y = (q.y + 10) / (1 - q.y / 32)
  const PlacedSprite p = placed(sprite, map);
  const CompositeResult result = composite({&p, 1}, {70, 500}, {0, 0, 0});
  EXPECT_EQ(difference(result.frame, reference::composite({&p, 1}, {70, 500}, {0, 0, 0})), "");
  EXPECT_EQ(result.frame.pixels[2 * 70 + 5].r, 0);                   // above the sprite's top edge
  EXPECT_EQ(result.frame.pixels[400 * 70 + 5], decode(kTestTexel));  // far down, still before the horizon
  // The part beyond would appear at negative y, or, mirrored, above the top edge.
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 70; ++x) ASSERT_EQ(result.frame.pixels[y * 70 + x], (Linear16{0, 0, 0, kOne}));
  }
}

TEST(Composite, NegativeDenominatorEverywhereShowsNothing) {
  const Sprite sprite = solid({64, 64}, kTestTexel);
  const CompositeResult result =
      one(sprite, -1.0 * translation(3, 3));  // the same points, all behind the eye
  EXPECT_EQ(difference(result.frame, background()), "");
  EXPECT_EQ(result.counters.pixels_composited, 0);
}

// With g = h = 0 and a common factor the map is affine in disguise; whole-texel positions are exact both
// ways.
TEST(Composite, PerspectiveOfACommonFactorEqualsAffine) {
  Random random(5);
  const Sprite sprite = make_sprite({50, 40}, [&](int, int) {
    return Texel{random.byte(), random.byte(), 1, random.byte()};
  });
  EXPECT_EQ(difference(one(sprite, 2.0 * translation(7, 5)).frame, one(sprite, translation(7, 5)).frame), "");
}

// Edges of sprites on and one pixel beside the boundaries of bands and tiles.
TEST(Composite, SpritesAtBandAndTileBoundaries) {
  Random random(9);
  std::vector<Sprite> sprites;
  for (const int side : {1, 31, 32, 33, 64}) {
    sprites.push_back(make_sprite({side, side}, [&](int, int) {
      return Texel{random.byte(), random.byte(), 8, random.byte()};
    }));
  }
  for (const Sprite& sprite : sprites) {
    for (const double x : {31.0, 32.0, 33.0, 31.5, 0.0, -31.0, 63.998, 64.002}) {
      for (const double y : {31.0, 32.0, 33.0, 31.5, 0.0, -32.0, 95.998, 96.002}) {
        const PlacedSprite p = placed(sprite, translation(x, y));
        expect_equals_reference({&p, 1}, {97, 97}, std::to_string(x) + " " + std::to_string(y));
      }
    }
  }
}

TEST(Composite, PixelCountIsTheTouchedRectangle) {
  const Sprite sprite = solid({40, 20}, kTestTexel);
  EXPECT_EQ(one(sprite, translation(10, 10), {200, 200}).counters.pixels_composited, 40 * 20);
  EXPECT_EQ(one(sprite, translation(10.5, 10.5), {200, 200}).counters.pixels_composited, 41 * 21);
  EXPECT_EQ(one(sprite, translation(-30, -15), {200, 200}).counters.pixels_composited, 10 * 5);
  EXPECT_EQ(one(sprite, translation(30, 30), {200, 200}).counters.sprite_bands, 2);
}

TEST(Composite, MultiplierZeroShowsNothing) {
  const Sprite sprite = solid({40, 40}, kTestTexel);
  PlacedSprite p = placed(sprite, translation(2, 2));
  p.alpha_multiplier = 0;
  EXPECT_EQ(difference(composite({&p, 1}, {70, 50}, {0.25f, 0.5f, 0.75f}).frame, background()), "");
  p.alpha_multiplier = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(difference(composite({&p, 1}, {70, 50}, {0.25f, 0.5f, 0.75f}).frame, background()), "");
}

TEST(Composite, MultipliersScaleColourAndAlpha) {
  const Sprite sprite = solid({8, 8}, {255, 255, 255, 255});
  PlacedSprite p = placed(sprite, translation(0, 0));
  p.color_multiplier = {0.5f, 0, 1};
  p.alpha_multiplier = 0.5f;
  const Linear16 pixel = composite({&p, 1}, {1, 1}, {0, 0, 0}).frame.pixels[0];
  EXPECT_EQ(pixel, (Linear16{16256, 0, 32513, 65025}));
}

TEST(SrgbBytes, EveryValueEqualsThePixelFunction) {
  Frame frame{static_cast<int>(kOne) + 1, 1, {}};
  for (std::uint32_t v = 0; v <= kOne; ++v) {
    const auto w = static_cast<std::uint16_t>(v);
    frame.pixels.push_back({w, static_cast<std::uint16_t>(kOne - v), 0, static_cast<std::uint16_t>(kOne)});
  }
  const std::vector<std::uint8_t> bytes = srgb_bytes(frame);
  ASSERT_EQ(bytes.size(), frame.pixels.size() * 3);
  for (std::uint32_t v = 0; v <= kOne; ++v) {
    ASSERT_EQ(bytes[3 * v], srgb_from_linear16(static_cast<std::uint16_t>(v)));
    ASSERT_EQ(bytes[3 * v + 1], srgb_from_linear16(static_cast<std::uint16_t>(kOne - v)));
    ASSERT_EQ(bytes[3 * v + 2], 0);
  }
  EXPECT_EQ(bytes[3 * kOne], 255);
}

}  // namespace
}  // namespace talisman::chunker
