// SPDX-License-Identifier: Apache-2.0
#include "chunker/fragment.h"

#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

constexpr LatticeBox kEveryPixel{0, 0, 31, 31};
constexpr int kTexel = 77;
constexpr std::uint16_t kFull = Samples<16>::kFull;

Fragment fragment(Float4 color, DepthPlane depth, std::uint32_t order, std::uint16_t mask = kFull) {
  Fragment f;
  f.color = color;
  f.depth = depth;
  f.order = order;
  f.mask = mask;
  return f;
}

const Float4 kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlue{0, 0, 1, 1}, kGlass{0.25f, 0.25f, 0.25f, 0.5f};

std::unique_ptr<FragmentBuffer<16>> buffer(MergeTolerance merge = {}, int limit = 4096) {
  auto b = std::make_unique<FragmentBuffer<16>>();
  b->clear(kEveryPixel, limit, merge);
  return b;
}

void expect_color(Float4 actual, Float4 expected) {
  for (int c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(actual[c], expected[c]) << "channel " << c;
}

// The bounds may decide only what comparisons one by one would decide; near-equal planes are where they
// could be wrong.
template <int kCount>
void compare_nearer_samples() {
  const unsigned seed = 8128;
  std::mt19937 random(seed);
  std::normal_distribution<float> wide(0, 1);
  int mixed = 0;
  for (int n = 0; n < 200000; ++n) {
    const float scale = std::pow(10.0f, -8 * static_cast<float>(random() % 1000) / 1000);
    const DepthPlane a{1 + wide(random), wide(random) * scale, wide(random) * scale};
    const DepthPlane b{a.z + wide(random) * scale, wide(random) * scale, a.dy};
    unsigned expected = 0;
    for (int s = 0; s < kCount; ++s) {
      const int place = Samples<kCount>::place(s);
      expected |= (depth_at(a, place) > depth_at(b, place) ? 1u : 0u) << s;
    }
    ASSERT_EQ(nearer_samples<kCount>(a, b), expected) << "seed " << seed << " n " << n;
    mixed += expected != 0 && expected != Samples<kCount>::kFull ? 1 : 0;
  }
  EXPECT_TRUE(kCount == 1 ? mixed == 0 : mixed > 10000);
}

TEST(NearerSamples, AgreesWithComparisonsOneByOne) {
  compare_nearer_samples<16>();
  compare_nearer_samples<4>();
  compare_nearer_samples<1>();
}

TEST(MeanOfSamples, OfEqualSamplesIsTheirValue) {
  for (const float v : {0.1f, 1.0f / 3, 0.7f, 12345.678f}) {
    std::array<Float4, 16> sixteen;
    sixteen.fill(splat(v));
    EXPECT_EQ(mean_of_samples(sixteen)[2], v);
    EXPECT_EQ(mean_of_samples(std::array{splat(v), splat(v), splat(v), splat(v)})[2], v);
    EXPECT_EQ(mean_of_samples(std::array{splat(v)})[2], v);
  }
}

TEST(FragmentBuffer, NothingIsClear) {
  auto b = buffer();
  EXPECT_TRUE(b->is_clear(kTexel));
  expect_color(b->resolve(kTexel), splat(0));
}

TEST(FragmentBuffer, OpaqueFullCoverIsTheBaseAndHidesWhatIsBehind) {
  auto b = buffer();
  EXPECT_EQ(b->add(kTexel, fragment(kRed, {2, 0, 0}, 0)), Added::BecameBase);
  EXPECT_TRUE(b->hides(kTexel, 0x00ff, {1, 0, 0}));
  EXPECT_FALSE(b->hides(kTexel, 0x00ff, {3, 0, 0}));
  EXPECT_FALSE(b->hides(kTexel + 1, 0x00ff, {1, 0, 0}));
  expect_color(b->resolve(kTexel), kRed);
}

// Equal depth is decided by order everywhere: the earlier surface is seen.
TEST(FragmentBuffer, AtEqualDepthTheEarlierSurfaceIsSeen) {
  auto b = buffer();
  b->add(kTexel, fragment(kRed, {2, 0.5f, 0}, 0));
  EXPECT_TRUE(b->hides(kTexel, kFull, {2, 0.5f, 0}));
  auto partial_first = buffer();
  partial_first->add(kTexel, fragment(kGreen, {2, 0, 0}, 0, 0x0fff));
  partial_first->add(kTexel, fragment(kRed, {2, 0, 0}, 1));
  expect_color(partial_first->resolve(kTexel), Float4{0.25f, 0.75f, 0, 1});
}

TEST(FragmentBuffer, ANearerBaseDropsHiddenFragmentsAndTheirPlaces) {
  auto b = buffer({}, 16);
  for (int round = 0; round < 100; ++round) {
    const float depth = 1 + static_cast<float>(round);
    for (int i = 0; i < 10; ++i)
      ASSERT_EQ(b->add(kTexel, fragment(kGlass, {depth, 0, 0}, static_cast<std::uint32_t>(round * 11 + i))),
                Added::Stored);
    ASSERT_EQ(
        b->add(kTexel, fragment(kBlue, {depth + 0.5f, 0, 0}, static_cast<std::uint32_t>(round * 11 + 10))),
        Added::BecameBase);
    ASSERT_EQ(b->live_fragments(), 0);
  }
  expect_color(b->resolve(kTexel), kBlue);
}

// Two opaque planes that cross in the middle of the texel: neither is in front, each wins its half.
TEST(FragmentBuffer, CrossingSurfacesShareTheTexel) {
  auto b = buffer();
  b->add(kTexel, fragment(kRed, {1, 1, 0}, 0));
  EXPECT_EQ(b->add(kTexel, fragment(kGreen, {1, -1, 0}, 1)), Added::Stored);
  expect_color(b->resolve(kTexel), Float4{0.5f, 0.5f, 0, 1});
}

// Panes come in any order; the picture is that of the right order: glass over blue glass over red.
TEST(FragmentBuffer, TranslucentSurfacesAreCompositedByDepth) {
  const Float4 blue_glass{0, 0, 0.5f, 0.5f};
  std::array<Fragment, 3> all{fragment(kRed, {1, 0, 0}, 0), fragment(blue_glass, {2, 0, 0}, 1),
                              fragment(kGlass, {3, 0, 0}, 2)};
  const Float4 expected{0.25f + 0.25f, 0.25f, 0.25f + 0.25f, 1};
  std::array<int, 3> order{0, 1, 2};
  do {
    auto b = buffer();
    for (const int i : order)
      if (!b->hides(kTexel, all[i].mask, all[i].depth)) b->add(kTexel, all[i]);
    expect_color(b->resolve(kTexel), expected);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(FragmentBuffer, PartialCoverIsWeightedByItsSamples) {
  auto b = buffer();
  b->add(kTexel, fragment(kRed, {1, 0, 0}, 0, 0x0007));
  expect_color(b->resolve(kTexel), Float4{3 / 16.0f, 0, 0, 3 / 16.0f});
}

TEST(Merge, JoinsDisjointPiecesOfTheSameSurface) {
  auto b = buffer({1e-4f, 1.0f / 512});
  b->add(kTexel, fragment(kRed, {1, 0, 0}, 0, 0x000f));
  EXPECT_EQ(b->add(kTexel, fragment(Float4{0.999f, 0, 0, 1}, {1.00005f, 0, 0}, 1, 0x00f0)), Added::Merged);
  EXPECT_EQ(b->live_fragments(), 1);
  expect_color(b->resolve(kTexel), Float4{0.5f, 0, 0, 0.5f});
}

// Each condition of the rule alone must prevent it: cover twice, another colour, another alpha, another
// depth, another slope.
TEST(Merge, AnyConditionPreventsIt) {
  const Fragment first = fragment(kRed, {1, 0, 0}, 0, 0x000f);
  const Fragment others[] = {
      fragment(kRed, {1, 0, 0}, 1, 0x0008), fragment(Float4{0.99f, 0, 0, 1}, {1, 0, 0}, 1, 0x00f0),
      fragment(Float4{1, 0, 0, 0.99f}, {1, 0, 0}, 1, 0x00f0), fragment(kRed, {1.01f, 0, 0}, 1, 0x00f0),
      fragment(kRed, {1, 0.01f, 0}, 1, 0x00f0)};
  for (const Fragment& other : others) {
    auto b = buffer({1e-4f, 1.0f / 512});
    b->add(kTexel, first);
    EXPECT_EQ(b->add(kTexel, other), Added::Stored);
  }
}

// Only the last one stored is looked at [A §1 row 9]; a NaN is never within a tolerance.
TEST(Merge, LooksOnlyAtTheLastStoredAndNeverAtNaN) {
  auto b = buffer({1e-4f, 1.0f / 512});
  b->add(kTexel, fragment(kRed, {1, 0, 0}, 0, 0x000f));
  b->add(kTexel, fragment(kGreen, {1, 0, 0}, 1, 0x00f0));
  EXPECT_EQ(b->add(kTexel, fragment(kRed, {1, 0, 0}, 2, 0x0f00)), Added::Stored);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(b->add(kTexel, fragment(Float4{nan, 0, 0, 1}, {1, 0, 0}, 3, 0xf000)), Added::Stored);
}

TEST(Merge, ZeroTolerancesMeanNever) {
  auto b = buffer();
  b->add(kTexel, fragment(kRed, {1, 0, 0}, 0, 0x000f));
  EXPECT_EQ(b->add(kTexel, fragment(kRed, {1, 0, 0}, 1, 0x00f0)), Added::Stored);
}

TEST(FragmentBuffer, RefusesBeyondItsLimitButStillTakesBases) {
  auto b = buffer({}, 16);
  for (std::uint32_t i = 0; i < 16; ++i)
    ASSERT_EQ(b->add(static_cast<int>(i), fragment(kGlass, {1, 0, 0}, i)), Added::Stored);
  EXPECT_EQ(b->add(20, fragment(kGlass, {1, 0, 0}, 16)), Added::Refused);
  EXPECT_EQ(b->add(21, fragment(kRed, {1, 0, 0}, 17)), Added::BecameBase);
}

// Random surfaces against a per-sample list that knows nothing of bases, dropping or sorting once.
template <int kCount>
void compare_with_sorted_lists() {
  constexpr std::uint16_t kAll = Samples<kCount>::kFull;
  const unsigned seed = 60;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int n = 0; n < 3000; ++n) {
    const auto b = std::make_unique<FragmentBuffer<kCount>>();
    b->clear(kEveryPixel, 4096, {});
    std::array<std::vector<Fragment>, kCount> lists;
    const int count = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < count; ++i) {
      const float alpha = random() % 2 ? 1 : unit(random);
      Fragment f = fragment(Float4{unit(random), unit(random), unit(random), 1} * splat(alpha),
                            {static_cast<float>(random() % 4) + 1, unit(random) - 0.5f, unit(random) - 0.5f},
                            static_cast<std::uint32_t>(i),
                            random() % 2 ? kAll : static_cast<std::uint16_t>((random() & kAll) | 1));
      if (random() % 3 == 0) f.depth.dx = f.depth.dy = 0;  // ties
      for (int s = 0; s < kCount; ++s)
        if (f.mask >> s & 1) lists[s].push_back(f);
      if (!b->hides(kTexel, f.mask, f.depth)) b->add(kTexel, f);
    }
    std::array<Float4, kCount> samples;
    for (int s = 0; s < kCount; ++s) {
      const int place = Samples<kCount>::place(s);
      std::stable_sort(lists[s].begin(), lists[s].end(), [&](const Fragment& p, const Fragment& q) {
        return depth_at(p.depth, place) > depth_at(q.depth, place);
      });
      SampleSum sum;
      for (const Fragment& f : lists[s]) sum.add_behind(f.color);
      samples[s] = sum.color;
    }
    const Float4 expected = mean_of_samples(samples), actual = b->resolve(kTexel);
    for (int c = 0; c < 4; ++c)
      ASSERT_EQ(actual[c], expected[c]) << kCount << " samples, seed " << seed << " n " << n;
  }
}

TEST(FragmentBuffer, ResolvesAsSortedListsWould) {
  compare_with_sorted_lists<16>();
  compare_with_sorted_lists<4>();
  compare_with_sorted_lists<1>();
}

}  // namespace
}  // namespace talisman::chunker
