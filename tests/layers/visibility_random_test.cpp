// SPDX-License-Identifier: Apache-2.0
// The visibility sort against slow oracles, on random moving bodies.
#include <gtest/gtest.h>

#include "layers/convex.h"
#include "layers/visibility.h"
#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

using tests::Dice;
using tests::MovingBodies;
using tests::Points;
using tests::World;

constexpr double kTouch = 1e-3;

// Every frame of the incremental sort is checked as if it were the only one.
void expect_valid_frames(unsigned seed, const MovingBodies& bodies, int frames, int& checked, int& cyclic) {
  VisibilitySorter sorter({kTouch, 0});
  for (int frame = 0; frame < frames; ++frame) {
    const World world = bodies.at(frame);
    const VisibilityOrder order = sorter.sort(world.eye, world.occluders());
    const tests::Relation relation = tests::slow_relation(world, kTouch);
    if (relation.empty() && !world.bodies.empty()) continue;
    ++checked;
    cyclic += !order.merged.empty();
    ASSERT_EQ(tests::wrong_with(order, relation, true), "") << "seed " << seed << ", frame " << frame;
    ASSERT_EQ(order.counters.undecided, 0) << "seed " << seed;
  }
}

TEST(VisibilityRandom, TenThousandScenesAgreeWithBruteForce) {
  int checked = 0, cyclic = 0;
  for (unsigned seed = 1; seed <= 10000 && !testing::Test::HasFatalFailure(); ++seed)
    expect_valid_frames(seed, MovingBodies(seed, 2 + static_cast<int>(seed % 4), 0.7 + 0.4 * (seed % 3), 0.2),
                        2, checked, cyclic);
  EXPECT_GT(checked, 19000) << "pairs that rounding decides are rare";
  EXPECT_GT(cyclic, 3000) << "the scenes hold both cyclic";
  EXPECT_LT(cyclic, 15000) << "and orderly worlds";
}

// Slow motion, so that most answers are kept from the frame before: a term that is too long shows here.
TEST(VisibilityRandom, KeptAnswersAreAsGoodAsNewOnes) {
  int checked = 0, cyclic = 0;
  for (unsigned seed = 1; seed <= 20 && !testing::Test::HasFatalFailure(); ++seed)
    expect_valid_frames(seed, MovingBodies(seed, 7, 2.5, seed % 2 ? 0.004 : 0.03), 120, checked, cyclic);
  EXPECT_GT(checked, 1900) << "worlds with points on needles are left out";
  EXPECT_GT(cyclic, 0);
}

TEST(DecideDepth, AgreesWithAllFacetPlanes) {
  Dice dice(7);
  for (int k = 0; k < 20000; ++k) {
    const World world = MovingBodies(1000 + k, 2, dice.uniform(0.1, 2), 0).at(0);
    const Points &a = world.bodies[0], &c = world.bodies[1];
    const double depth = tests::slow_depth(a, c);
    for (const double tolerance : {1e-12, 0.01, 0.2}) {
      if (std::fabs(depth - tolerance) < 1e-9) continue;
      const DepthDecision d = decide_depth({a}, {c}, tolerance);
      ASSERT_EQ(d.deeper, depth > tolerance)
          << "bodies " << k << " depth " << depth << " against " << tolerance;
      ASSERT_TRUE(d.decided) << k;
      ASSERT_LE(d.lower, d.upper + 1e-12);
      if (depth > 0) {
        ASSERT_LE(d.lower, depth + 1e-9) << k;
        ASSERT_GE(d.upper, depth - 1e-9) << k;
      }
    }
  }
}

}  // namespace
}  // namespace talisman::layers
