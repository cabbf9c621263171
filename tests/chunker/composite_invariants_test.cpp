// SPDX-License-Identifier: Apache-2.0
/// What `over` promises, and what the shadow sprites of [LS97 appendix] cost.

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "chunker/composite.h"
#include "chunker/span_composite.h"
#include "tests/chunker/composite_fixtures.h"

namespace talisman::chunker {
namespace {

constexpr ivec2 kDisplay{48, 40};

Frame layers_over(std::span<const Sprite> sprites, layers::vec3 background) {
  std::vector<PlacedSprite> stack;
  for (const Sprite& s : sprites) stack.push_back(placed(s, translation(0, 0)));
  return composite(stack, kDisplay, background).frame;
}

Footprints every_pixel(Texel t) {
  const Texel pair[2] = {t, t};
  Footprints f;
  for (int k = 0; k < kRunPixels; ++k) {
    std::memcpy(&f.top[k], pair, sizeof pair);
    f.bottom[k] = f.top[k];
    f.weight_x[k] = f.weight_y[k] = weight_pair(0);
  }
  return f;
}

PackedPixel pack(Linear16 p) {
  PackedPixel packed;
  std::memcpy(&packed, &p, sizeof p);
  return packed;
}

Linear16 unpack(PackedPixel packed) {
  Linear16 p;
  std::memcpy(static_cast<void*>(&p), &packed, sizeof p);
  return p;
}

/// [colour, alpha] of `source` over [colour, alpha] of `below`. The frame itself is always opaque; the inner
/// loop is not bound to that.
Linear16 over(Texel source, Linear16 below) {
  alignas(64) PackedPixel line[kRunPixels];
  std::fill_n(line, kRunPixels, pack(below));
  blend_run(every_pixel(source), Multiplier{}, line);
  return unpack(line[kRunPixels - 1]);
}

std::uint32_t rounded_share(std::uint64_t v, std::uint64_t share) {
  return static_cast<std::uint32_t>((v * share + kOne / 2) / kOne);
}

TEST(Over, ClearSpriteChangesNothing) {
  Random random(1);
  const Sprite below[] = {make_sprite(kDisplay,
                                      [&](int, int) {
                                        return Texel{random.byte(), random.byte(), 3, 255};
                                      }),
                          Sprite(kDisplay), solid(kDisplay, {})};
  EXPECT_EQ(difference(layers_over(below, {0, 0, 0}), layers_over({below, 1}, {0, 0, 0})), "");
}

TEST(Over, OpaqueSpriteHidesWhatIsBelow) {
  Random random(2);
  const Sprite stack[] = {random.sprite(40), make_sprite(kDisplay, [&](int, int) {
                            return Texel{random.byte(), random.byte(), 3, 255};
                          })};
  EXPECT_EQ(difference(layers_over(stack, {0, 1, 0}), layers_over({stack + 1, 1}, {1, 0, 1})), "");
}

// Alpha zero makes over a sum: three additive sprites commute, and white plus white stays white.
TEST(Over, AlphaZeroAddsAndSaturates) {
  const Texel lights[] = {{100, 20, 3, 0}, {50, 200, 9, 0}, {210, 180, 255, 0}};
  const Linear16 black{0, 0, 0, kOne};
  const Linear16 forward = over(lights[2], over(lights[1], over(lights[0], black)));
  const Linear16 backward = over(lights[0], over(lights[1], over(lights[2], black)));
  EXPECT_EQ(forward, backward);
  EXPECT_EQ(forward.r, 100 * 100 + 50 * 50 + 210 * 210);
  EXPECT_EQ(forward.g, kOne);  // 20² + 200² + 180² = 72800
  EXPECT_EQ(forward.b, kOne);  // 9 + 81 + 65025
  EXPECT_EQ(forward.a, kOne);
}

// All alphas against values around every place where a quotient could round the wrong way.
TEST(Over, DivisionIsRoundedExactly) {
  for (int alpha = 0; alpha < 256; ++alpha) {
    const Texel black{0, 0, 0, static_cast<std::uint8_t>(alpha)};
    for (std::uint32_t value = 0; value + 2 <= kOne; value += 3 * (1 + value % 7)) {
      const auto v = static_cast<std::uint16_t>(value);
      const Linear16 below{v, static_cast<std::uint16_t>(v + 1), static_cast<std::uint16_t>(v + 2), kOne};
      const Linear16 result = over(black, below);
      const std::uint32_t through = kOne - alpha * 255u;
      ASSERT_EQ(result.r, rounded_share(below.r, through)) << alpha << ' ' << value;
      ASSERT_EQ(result.g, rounded_share(below.g, through)) << alpha << ' ' << value;
      ASSERT_EQ(result.b, rounded_share(below.b, through)) << alpha << ' ' << value;
      ASSERT_EQ(result.a, kOne);
    }
  }
}

// (a over b) over c = a over (b over c). The left side needs a over b as a value that no texel can hold, so
// it is worked out in double here; each `over` of the right side rounds by at most half a unit, twice.
TEST(Over, IsAssociativeWithinRounding) {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto translucent = [&] {
      const std::uint8_t alpha = random.byte();
      const auto most = static_cast<int>(std::sqrt(alpha * 255.0));
      const auto color = [&] { return static_cast<std::uint8_t>(random.integer(0, most)); };
      return Texel{color(), color(), color(), alpha};
    };
    const Texel a = translucent(), b = translucent();
    const Linear16 c = decode({random.byte(), random.byte(), random.byte(), 255});
    const Linear16 da = decode(a), db = decode(b);
    const double through_a = 1 - da.a / double(kOne), through_ab = through_a * (1 - db.a / double(kOne));
    const double left = da.g + db.g * through_a + c.g * through_ab;
    const double right = over(a, over(b, c)).g;
    worst = std::max(worst, std::abs(left - right));
  }
  EXPECT_LE(worst, 1.0 + 1e-6);
  EXPECT_GT(worst, 0.1);  // it does round
}

TEST(Over, ColourStaysAtMostAlphaWhereItWas) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const std::uint8_t alpha = random.byte();
    const auto color = static_cast<std::uint8_t>(std::sqrt(alpha * 255.0));
    const std::uint8_t below_alpha = random.byte();
    const auto below_color = static_cast<std::uint8_t>(std::sqrt(below_alpha * 255.0));
    const Linear16 result = over({color, 0, color, alpha}, decode({below_color, 0, 0, below_alpha}));
    ASSERT_LE(result.r, result.a);
    ASSERT_LE(result.a, kOne);
  }
}

// [LS97 appendix]: the receiver is [βB, β], the shadow sprite [0, (1 - s)β]. Over gives
//   colour  sβB + (1 - s)(1 - β)βB,   alpha  β + (1 - s)(1 - β)β,
// that is, errors of (1 - s)(1 - β)βB and (1 - s)(1 - β)β against [sβB, β].
TEST(ShadowSprite, ErrorIsWhatTheAppendixPredicts) {
  for (int beta8 = 0; beta8 <= 255; beta8 += 5) {
    for (int s_percent = 0; s_percent <= 100; s_percent += 4) {
      const double beta = beta8 / 255.0, s = s_percent / 100.0, color = 0.8;
      const Texel receiver = encode({static_cast<float>(beta * color), 0, 0, static_cast<float>(beta)});
      const Texel shadow = encode({0, 0, 0, static_cast<float>((1 - s) * beta)});
      const Linear16 below = decode(receiver), result = over(shadow, below);
      // The sprite's alpha has 8 bits; the prediction uses the s that was stored, so that only compositing is
      // tested.
      const double stored_s = beta8 == 0 ? 1 : 1 - (shadow.a / 255.0) / (receiver.a / 255.0);
      const double color_error = (1 - stored_s) * (1 - beta) * below.r;
      const double alpha_error = (1 - stored_s) * (1 - beta) * beta * kOne;
      ASSERT_NEAR(result.r, stored_s * below.r + color_error, 1) << beta << ' ' << s;
      ASSERT_NEAR(result.a, beta * kOne + alpha_error, 1) << beta << ' ' << s;
    }
  }
}

TEST(ShadowSprite, IsExactWithoutShadowAndUnderFullCoverage) {
  for (int beta8 = 0; beta8 <= 255; ++beta8) {  // s = 1: the shadow sprite is clear
    const Linear16 receiver = decode(encode({0.6f * beta8 / 255, 0.1f, 0, beta8 / 255.0f}));
    ASSERT_EQ(over(encode({0, 0, 0, 0}), receiver), receiver);
  }
  const Linear16 receiver = decode(encode({0.6f, 0.3f, 0.1f, 1}));
  for (int shade = 0; shade <= 255; ++shade) {  // β = 1
    const Linear16 result = over({0, 0, 0, static_cast<std::uint8_t>(255 - shade)}, receiver);
    const std::uint32_t s = shade * 255u;
    ASSERT_EQ(result.r, rounded_share(receiver.r, s));
    ASSERT_EQ(result.g, rounded_share(receiver.g, s));
    ASSERT_EQ(result.a, kOne);
  }
}

// A frame stays opaque whatever is laid over it.
TEST(CompositeInvariants, FramesStayOpaque) {
  Random random(5);
  std::vector<Sprite> sprites;
  std::vector<PlacedSprite> stack;
  for (int i = 0; i < 6; ++i) sprites.push_back(random.sprite(90));
  for (const Sprite& s : sprites) {
    const double angle = random.real(-1, 1);
    stack.push_back(placed(s, affine(std::cos(angle), -std::sin(angle), random.real(0, 30), std::sin(angle),
                                     std::cos(angle), 3)));
  }
  for (const Linear16& p : composite(stack, {100, 80}, {0.3f, 0.3f, 0.3f}).frame.pixels) {
    ASSERT_EQ(p.a, kOne);
    ASSERT_LE(std::max({p.r, p.g, p.b}), kOne);
  }
}

// Moving everything by whole tiles moves the picture and changes nothing else: runs are aligned to the
// display.
TEST(CompositeInvariants, TranslationByWholeTilesMovesThePicture) {
  Random random(6);
  const Sprite sprite = make_sprite({60, 50}, [&](int, int) {
    return Texel{random.byte(), random.byte(), 3, random.byte()};
  });
  const dmat3 map =
      affine(1, 0.25, 4.125, 0, 1, 12.5);  // its inverse and that of its copy are exact in double
  const PlacedSprite here = placed(sprite, map), there = placed(sprite, translation(64, 32) * map);
  const Frame a = composite({&here, 1}, {128, 96}, {0, 0, 0}).frame;
  const Frame b = composite({&there, 1}, {192, 128}, {0, 0, 0}).frame;
  int shown = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Linear16 p = a.pixels[y * 128 + x];
      ASSERT_EQ(p, b.pixels[(y + 32) * 192 + x + 64]) << x << ' ' << y;
      shown += p.r > 0;
    }
  }
  EXPECT_GT(shown, 1500);
}

TEST(CompositeOnto, StackInPartsEqualsTheWhole) {
  // 48 x 40 pixels: the last tiles of a line and the last band are cut.
  const std::uint64_t seed = 20260407;
  SCOPED_TRACE(seed);
  Random random(seed);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Sprite> sprites;
    for (int k = 0; k < 4; ++k) sprites.push_back(random.sprite(70));
    std::vector<PlacedSprite> stack;
    for (const Sprite& sprite : sprites) {
      stack.push_back(placed(sprite, translation(random.real(-20, 30), random.real(-20, 30))));
      stack.back().alpha_multiplier = random.chance(0.5) ? 1.0f : 0.4f;
    }
    const std::size_t cut = random.integer(0, 4);
    const std::span<const PlacedSprite> all(stack);
    const CompositeResult whole = composite(all, kDisplay, {0.2f, 0.4f, 0.6f});
    CompositeResult parts = composite(all.first(cut), kDisplay, {0.2f, 0.4f, 0.6f});
    parts.counters += composite_onto(parts.frame, all.subspan(cut));
    EXPECT_EQ(difference(parts.frame, whole.frame), "") << "trial " << trial << ", cut " << cut;
    EXPECT_EQ(of_the_model(parts.counters), of_the_model(whole.counters));
  }
}

TEST(CompositeOnto, ClearFrameTakesTheTexelsWithTheirAlpha) {
  // On a frame that is not opaque, alpha has to be composited too: translucent over nothing is itself.
  Random random(7);
  const Sprite sprite = make_sprite(kDisplay, [&](int, int) {
    return Texel{random.byte(), random.byte(), random.byte(), random.byte()};
  });
  Frame frame{kDisplay.x, kDisplay.y, {}};
  frame.pixels.resize(static_cast<std::size_t>(kDisplay.x) * kDisplay.y);
  const PlacedSprite one = placed(sprite, translation(0, 0));
  composite_onto(frame, {&one, 1});
  for (int y = 0; y < kDisplay.y; ++y)
    for (int x = 0; x < kDisplay.x; ++x)
      ASSERT_EQ(to_string(frame.pixels[y * kDisplay.x + x]), to_string(decode(sprite.texel(x, y))));
}

}  // namespace
}  // namespace talisman::chunker
