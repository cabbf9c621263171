// SPDX-License-Identifier: Apache-2.0
// Rules of the speed-ups of [F96], fed with what they must refuse.
#include <gmock/gmock.h>

#include "sequences/experiments/reproduction/fearing/fixed_cost_96.h"
#include "sequences/experiments/reproduction/fearing/speed_ups_96.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;

std::vector<SpeedUpCell> cells_with(const std::vector<double>& at_half, double all_moves = 0.9) {
  std::vector<SpeedUpCell> cells;
  int slice = 2;
  for (const double ours : at_half) {
    cells.push_back({100, {slice, 2}, 0.87, all_moves});
    cells.push_back({50, {slice, 2}, 1.2, ours});
    slice *= 2;
  }
  return cells;
}

TEST(SpeedUps96, AFallOfMoreThanThreePerCentIsANo) {
  EXPECT_TRUE(rising_96(cells_with({1.0, 1.2, 1.18, 1.4})).same) << "2 % are a standstill";
  const Finding falls = rising_96(cells_with({1.0, 1.2, 1.16, 1.4}));
  EXPECT_FALSE(falls.same);
  EXPECT_THAT(falls.ours, HasSubstr("N = 8, k = 2, 50 %: 1.16 after 1.20"));
  EXPECT_FALSE(rising_96(cells_with({1.0, 1.2, 1.19, 1.16})).same) << "in small steps, too";
  EXPECT_FALSE(rising_96({}).same);
  EXPECT_TRUE(rising_96(cells_with({1.0, 1.0}, 0.1)).same) << "where all moves nothing has to rise";
}

TEST(SpeedUps96, TheOrderHasTiesOfFivePerCent) {
  EXPECT_TRUE(order_96({3, 5.6, 4.6, 16, 18}).same);
  EXPECT_TRUE(order_96({3, 4.5, 4.6, 16, 15.5}).same);
  EXPECT_FALSE(order_96({3, 4.3, 4.6, 16, 18}).same);
  EXPECT_FALSE(order_96({3, 5.6, 4.6, 16, 12}).same);
  EXPECT_FALSE(order_96({}).same);
  EXPECT_THAT(order_96({3, 5.6, 4.6, 16, 18}).ours, HasSubstr("molecules 18.00 > particles 16.00"));
}

TEST(SpeedUps96, WhereNothingRestsNoneIsGainedAndLittleIsLost) {
  EXPECT_TRUE(nothing_rests_96(cells_with({1, 1}, 0.86)).same);
  EXPECT_FALSE(nothing_rests_96(cells_with({1, 1}, 0.8)).same);
  EXPECT_FALSE(nothing_rests_96(cells_with({1, 1}, 1.2)).same);
  EXPECT_FALSE(nothing_rests_96({}).same);
}

TEST(MotionThresholds96, OnePixelLiftsAndFallsWithTheSlice) {
  EXPECT_TRUE(lifted_96({1.46, 1.31, 1.29, 1.26, 1.23}).same);
  EXPECT_FALSE(lifted_96({1.46, 1.60, 1.29, 1.26, 1.23}).same);
  EXPECT_FALSE(lifted_96({1.46, 1.31, 1.29, 1.26, 0.97}).same);
  EXPECT_FALSE(lifted_96({}).same);
}

TEST(MotionThresholds96, HalfAPixelLiftsNoMoreThanAWholeOne) {
  EXPECT_TRUE(no_higher_96({1.4, 1.17}, {1.6, 1.13}).same) << "a tie";
  EXPECT_FALSE(no_higher_96({1.4, 1.2}, {1.6, 1.13}).same);
  EXPECT_FALSE(no_higher_96({1.4}, {1.6, 1.13}).same);
  EXPECT_FALSE(no_higher_96({}, {}).same);
}

TEST(MotionThresholds96, TwoBuffersAreIndifferentWithinFivePerCent) {
  const std::vector<SpeedUpCell> one = {{100, {8, 8}, 0, 0.87}}, near = {{100, {8, 8}, 0, 0.9}},
                                 far = {{100, {8, 8}, 0, 0.95}};
  EXPECT_TRUE(indifferent_96({one, one, near}).same);
  EXPECT_FALSE(indifferent_96({one, one, far}).same);
  EXPECT_FALSE(indifferent_96({one, one}).same) << "one threshold is missing";
  EXPECT_FALSE(indifferent_96({}).same);
}

TEST(FixedCost96, AShareOfTheBoundOrTwoMilliseconds) {
  const FrameParts direct{1, 99, 0, 100}, fast{1.5, 4.5, 1, 7}, slow{2, 20, 5, 27}, cheap{1.5, 20, 1, 22.5};
  EXPECT_TRUE(fixed_cost_96(direct, fast, 0.7).same);   // 14.3-fold
  EXPECT_FALSE(fixed_cost_96(direct, slow, 0.7).same);  // 3.7-fold, 6 ms
  EXPECT_TRUE(fixed_cost_96(direct, cheap, 0.7).same);  // 4.4-fold, 1.5 ms
  EXPECT_FALSE(fixed_cost_96(direct, {}, 0.7).same) << "nothing was measured";
  EXPECT_THAT(fixed_cost_96(direct, slow, 0.7).ours, HasSubstr("prediction 1.00, joining and clearing 5.00"));
}

// The prices of the machine give the printed bound where nothing costs anything but drawing.
TEST(Iris96, ASpeedUpIsWhatTheWorkSays) {
  Work96 work;
  work.quads = 144'000;
  work.quads_drawn = 14'400;
  EXPECT_NEAR(speed_up(TestScenario96::Particles, work), 10, 1e-9);
  work.primitives = 1000;  // 50 ms of 14,155
  work.joins = 1;          // 120 ms
  EXPECT_NEAR(speed_up(TestScenario96::Particles, work), 14155.2 / (1415.52 + 170), 1e-6);
}

TEST(Iris96, OfBlocksThatAllMoveEveryOneIsDrawnInEveryFrame) {
  const Work96 work = counted_work({TestScenario96::Blocks, 100, false, 0.01, {8, 2}});
  EXPECT_EQ(work.quads, 6000);
  EXPECT_EQ(work.primitives, 1000);
  EXPECT_NEAR(work.quads_drawn, work.quads, 30) << "some are too far away to be seen to move";
  EXPECT_LE(work.joins, 1);
}

}  // namespace
}  // namespace talisman::sequences
