// SPDX-License-Identifier: Apache-2.0
// Share a sprite or not: the sums, worked out by hand.
#include "regulator/regroup.h"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/plan.h"

namespace talisman::regulator {
namespace {

using ::testing::HasSubstr;

constexpr double kNoCeiling = HUGE_VAL;

RegroupOptions modelled() {
  RegroupOptions options;
  options.by = Regroup::Amortised;
  return options;
}

/// 1,500 polygons are 1 ms, 40,000 texels 1 ms, 320,000 pixels 1 ms.
TEST(Regroup, APriceIsThatOfTheReferenceDesign) {
  const SpritePrice by_polygons = modelled_price(1500, 4000, 32'000, 4);
  EXPECT_DOUBLE_EQ(by_polygons.render_ms, 1);
  EXPECT_DOUBLE_EQ(by_polygons.reuse_ms, 0.1 + kReuseOverhead_ms);
  EXPECT_DOUBLE_EQ(by_polygons.ms_per_frame(), 0.25 + 0.1 + kReuseOverhead_ms);
  EXPECT_DOUBLE_EQ(modelled_price(15, 80'000, 0, 1).render_ms, 2);
  EXPECT_EQ(modelled_price(1, 1, 1, 0).run_frames, 1);
  EXPECT_EQ(modelled_price(1, 1, 1, std::nan("")).run_frames, 1);
}

/// Two that lie over each other: each 1 ms to draw and 0.4 ms to show, for 10 frames; together 1.8 and 0.5 ms. Apart a
/// frame is 2 · 0.5 = 1.0 ms, together 0.68: ten frames are 10 against 6.8.
TEST(Regroup, LayersThatLieOverEachOtherAndLastAsLongAreMerged) {
  const SpritePrice one{1, 0.4, 10, 0}, both{1.8, 0.5, 10, 0};
  const RegroupVerdict verdict = weigh_merge(one, one, both, modelled(), kNoCeiling);
  EXPECT_TRUE(verdict.is_made());
  EXPECT_DOUBLE_EQ(verdict.terms.unoptimised_ms, 1.0);
  EXPECT_DOUBLE_EQ(verdict.saved_ms(), 10 - 5 - 1.8);
  EXPECT_EQ(in_words(verdict), "1.8 ms once and 0.5 ms a frame < 1 ms a frame, for 10 frames");
}

/// One rests, the other is drawn in every frame: together both would be.
TEST(Regroup, WhatRestsIsNotMergedWithWhatIsDrawnInEachFrame) {
  const SpritePrice rests{3, 0.2, 200, 0}, moves{0.5, 0.1, 1, 0}, both{3.4, 0.25, 1, 0};
  EXPECT_FALSE(weigh_merge(rests, moves, both, modelled(), kNoCeiling).pays);
  const std::array<SpritePrice, 2> apart{rests, moves};
  EXPECT_TRUE(weigh_split(both, apart, 0, modelled(), kNoCeiling).is_made());
}

/// Two that are drawn in every frame anyway and overlap: one sprite is filled and read for both.
TEST(Regroup, TwoThatAreDrawnInEachFrameAreMergedWhereTheyOverlap) {
  const SpritePrice one{1, 0.2, 1, 0}, together{1.2, 0.25, 1, 0}, far_apart{6, 1.5, 1, 0};
  EXPECT_TRUE(weigh_merge(one, one, together, modelled(), kNoCeiling).is_made());
  EXPECT_FALSE(weigh_merge(one, one, far_apart, modelled(), kNoCeiling).pays);
}

TEST(Regroup, ACloseCallIsLeftAsItIs) {
  const SpritePrice one{1, 0, 10, 0},
      both{1.92, 0, 10, 0};  // 0.2 a frame against 0.192; 0.01 is a tenth of one
  EXPECT_FALSE(weigh_merge(one, one, both, modelled(), kNoCeiling).pays);
  const std::array<SpritePrice, 2> apart{one, one};
  EXPECT_FALSE(weigh_split(both, apart, 0, modelled(), kNoCeiling).pays);
}

/// What is small beside its neighbour is merged for what it costs itself: 0.05 of 1.05 ms.
TEST(Regroup, SomethingSmallIsMergedIntoSomethingLargeThatIsDrawnAnyway) {
  const SpritePrice large{0.9, 0.1, 1, 0}, small{0.04, 0.01, 1, 0}, both{0.91, 0.1, 1, 0};
  EXPECT_TRUE(weigh_merge(large, small, both, modelled(), kNoCeiling).is_made());
}

TEST(Regroup, NoChangeCostsMoreAtOnceThanTheCeiling) {
  const SpritePrice one{1, 0.4, 10, 0}, both{1.8, 0.5, 10, 0};
  for (const auto& [ceiling_ms, made] : {std::pair{1.79, false}, {1.8, true}, {0.0, false}}) {
    const RegroupVerdict verdict = weigh_merge(one, one, both, modelled(), ceiling_ms);
    EXPECT_TRUE(verdict.pays);
    EXPECT_EQ(verdict.is_made(), made) << ceiling_ms;
    EXPECT_EQ(verdict.is_above_ceiling, !made) << ceiling_ms;
  }
}

/// A split is paid for with the renders of those whose sprites no longer serve, over the frames that it is to last.
TEST(Regroup, ASplitHasToEarnItsRenders) {
  const SpritePrice part{1, 0.1, 20, 0}, both{2, 0.2, 6, 0};  // 0.15 · 2 = 0.3 apart, 0.533 together
  const std::array<SpritePrice, 2> apart{part, part};
  EXPECT_TRUE(weigh_split(both, apart, 0, modelled(), kNoCeiling).is_made());
  EXPECT_TRUE(weigh_split(both, apart, 4, modelled(), kNoCeiling).is_made());  // 20 · 0.233 = 4.67 earned
  EXPECT_FALSE(weigh_split(both, apart, 5, modelled(), kNoCeiling).pays);
}

TEST(Regroup, ByThePaperLayersAreMergedAtTenFramesAndNeverAtNine) {
  RegroupOptions options = modelled();
  options.prices = RegroupPrices::Durbin1995;
  for (const std::int64_t polygons : {2, 12'345}) {
    const SpritePrice any{0, 0, 1, polygons / 2};
    for (const auto& [frames, merged] :
         {std::pair{1.0, false}, {9.0, false}, {9.87, false}, {9.88, true}, {10.0, true}}) {
      const SpritePrice both{0, 0, frames, polygons};
      EXPECT_EQ(weigh_merge(any, any, both, options, kNoCeiling).is_made(), merged) << frames;
      const std::array<SpritePrice, 2> apart{any, any};
      EXPECT_EQ(weigh_split(both, apart, 0, options, kNoCeiling).pays, !merged) << frames;
    }
  }
}

TEST(Regroup, OptionsOutOfRangeAreNamed) {
  RegulatorOptions options;
  options.regroup.ceiling_ms = -1;
  EXPECT_THAT(first_defect(options), HasSubstr("regroup_ceiling_ms is -1"));
  options.regroup = {};
  options.regroup.ceiling_ms = std::nan("");
  EXPECT_THAT(first_defect(options), HasSubstr("regroup_ceiling_ms"));
  options.regroup = {};
  options.regroup.dwell_frames = 0;
  EXPECT_THAT(first_defect(options), HasSubstr("regroup_dwell is 0"));
  options.regroup = {};
  options.regroup.recency = 0;
  EXPECT_THAT(first_defect(options), HasSubstr("regroup_recency is 0"));
}

TEST(Regroup, OnlyThresholdRegroups) {
  RegulatorOptions options;
  options.regroup.by = Regroup::Amortised;
  for (const Policy policy : kAllPolicies) {
    options.policy = policy;
    EXPECT_EQ(regroups(options), policy == Policy::Threshold) << name(policy);
  }
  options.policy = Policy::Threshold;
  options.regroup.by = Regroup::None;
  EXPECT_FALSE(regroups(options));
}

}  // namespace
}  // namespace talisman::regulator
