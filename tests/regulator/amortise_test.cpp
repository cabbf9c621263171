// SPDX-License-Identifier: Apache-2.0
// The utility test of [D95] and what it is fed with.
#include "regulator/amortise.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

TEST(Amortise, TheFiguresOfThePaperPayFromTheTenthFrameOnWhateverTheSize) {
  for (const std::int64_t polygons : {1, 7, 5'500, 1'418'807}) {
    const Amortisation terms = durbin_1995(polygons);
    EXPECT_NEAR(break_even_frames(terms), 87.9 / (12.7 - 3.8), 1e-9) << polygons;
    EXPECT_FALSE(pays(terms, 9)) << polygons;
    EXPECT_TRUE(pays(terms, 10)) << polygons;
  }
}

/// As printed, AUT is a share of the frames: then nothing would ever be optimised.
TEST(Amortise, AShareOfTheFramesNeverPays) {
  const Amortisation terms = durbin_1995(1000);
  for (const double share : {0.0, 0.5, 0.99, 1.0}) EXPECT_FALSE(pays(terms, share)) << share;
}

TEST(Amortise, InTheLongRunAFrameIsThreeAndAThirdTimesAsFast) {
  const Amortisation terms = durbin_1995(100);
  EXPECT_NEAR(terms.unoptimised_ms / terms.optimised_ms, 3.342, 1e-3);
}

TEST(Amortise, AtTheBreakEvenNothingIsGained) {
  const Amortisation terms{2, 1, 10};
  EXPECT_EQ(break_even_frames(terms), 10);
  EXPECT_FALSE(pays(terms, 10));
  EXPECT_TRUE(pays(terms, 10.001));
}

TEST(Amortise, WhatIsNoCheaperNeverPays) {
  EXPECT_EQ(break_even_frames({1, 1, 0}), HUGE_VAL);
  EXPECT_EQ(break_even_frames({1, 2, 0}), HUGE_VAL);
  EXPECT_FALSE(pays({1, 1, 0}, 1e9));
  EXPECT_FALSE(pays({0, 0, 0}, 1e9));
}

TEST(Amortise, WhatIsFreeAtOncePaysWithTheFirstFrame) { EXPECT_TRUE(pays({2, 1, 0}, 1)); }

TEST(Amortise, NothingThatIsNotFinitePays) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pays({2, 1, 1}, nan));
  EXPECT_FALSE(pays({nan, 1, 1}, 100));
  EXPECT_FALSE(pays({2, nan, 1}, 100));
  EXPECT_FALSE(pays({2, 1, nan}, 100));
  EXPECT_FALSE(pays({2, 1, HUGE_VAL}, 100));
  EXPECT_FALSE(pays({2, 1, 1}, HUGE_VAL));
}

// --- How long things last ---

RunLength after_runs(std::initializer_list<int> lengths, double recency) {
  RunLength run;
  for (const int length : lengths) {
    for (int frame = 0; frame < length; ++frame) run.frame_passed();
    run.ended(recency);
  }
  return run;
}

TEST(RunLength, WithoutARunOneFrameIsExpected) { EXPECT_EQ(RunLength().expected(), 1); }

TEST(RunLength, OneRunIsItsOwnMean) { EXPECT_EQ(after_runs({7}, 0.25).expected(), 7); }

TEST(RunLength, TheLastRunCountsByItsWeight) {
  EXPECT_DOUBLE_EQ(after_runs({8, 4}, 0.25).expected(), 7);
  EXPECT_DOUBLE_EQ(after_runs({8, 4, 4}, 0.25).expected(), 6.25);
  EXPECT_DOUBLE_EQ(after_runs({8, 4}, 1).expected(), 4);
}

TEST(RunLength, WhatLastsLongerThanEverIsExpectedToLastThatLong) {
  RunLength run = after_runs({2, 2, 2}, 0.25);
  for (int frame = 0; frame < 9; ++frame) run.frame_passed();
  EXPECT_EQ(run.expected(), 9);
  run.interrupted();
  EXPECT_EQ(run.expected(), 2);
}

/// A layer that stood for a long time and now changes in every frame: in how many frames is that noticed?
TEST(RunLength, AChangeOfPaceIsNoticedWithinAFewRuns) {
  RunLength run = after_runs({400}, 0.25);
  int frames = 0;
  for (; run.expected() > 10; ++frames) {
    run.frame_passed();
    run.ended(0.25);
  }
  EXPECT_LE(frames, 14);  // 400 · 0.75ⁿ < 9
}

}  // namespace
}  // namespace talisman::regulator
