// SPDX-License-Identifier: Apache-2.0
// The parts of the visibility sort: depth of convex bodies, angular extents and their tree, the line.
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/convex.h"
#include "layers/extent_tree.h"
#include "layers/visibility_order.h"
#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using tests::box;
using tests::Dice;
using tests::Points;

TEST(DecideDepth, GapBetweenBoxesIsBoundedFromBothSides) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), c = box({5, 0.5, 0.2}, {1, 1, 1});
  const DepthDecision d = decide_depth({a}, {c}, 0);
  EXPECT_FALSE(d.deeper);
  EXPECT_LE(d.lower, -3);
  EXPECT_GE(d.upper, -3);
  EXPECT_LE(d.upper, -1.5) << "within a factor of two";
  EXPECT_NEAR(glm::length(d.normal), 1, 1e-12);
}

TEST(DecideDepth, DepthOfOverlapIsBoundedFromBothSides) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), c = box({1.5, 0.3, 0}, {1, 1, 1});
  const DepthDecision d = decide_depth({a}, {c}, 0.01);
  EXPECT_TRUE(d.deeper);
  EXPECT_LE(d.lower, 0.5 + 1e-12);
  EXPECT_GT(d.lower, 0.01);
  EXPECT_GE(d.upper, 0.5 - 1e-12);
}

// Either side of the exact depth of 0.5, and the exact touch.
TEST(DecideDepth, ToleranceIsMetToRounding) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), c = box({1.5, 0, 0}, {1, 1, 1}),
               touching = box({2, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(decide_depth({a}, {c}, 0.5 - 1e-9).deeper);
  EXPECT_FALSE(decide_depth({a}, {c}, 0.5 + 1e-9).deeper);
  EXPECT_FALSE(decide_depth({a}, {touching}, 1e-14).deeper);
}

TEST(DecideDepth, EmptySetsAreNotDeep) {
  const Points a = box({0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(decide_depth({a}, {}, 0).deeper);
  EXPECT_FALSE(decide_depth({}, {}, 0).deeper);
}

TEST(DecideDepth, ApexBelongsToTheSet) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), c = box({0, 0, -9}, {1, 1, 1});
  const dvec3 beyond{0, 0, 9}, beside{0, 0, -4};
  EXPECT_TRUE(decide_depth({a}, {c, &beyond}, 0.1).deeper);
  EXPECT_FALSE(decide_depth({a}, {c, &beside}, 0.1).deeper);
  EXPECT_FALSE(decide_depth({a}, {{}, &a[0]}, 0).deeper) << "a corner only touches";
}

// No volume anywhere, in all combinations: the depth is 0 or negative, and nothing may loop or divide by 0.
TEST(DecideDepth, FlatBodiesHaveNoDepth) {
  const std::vector<Points> flat = {{{0, 0, 0}},
                                    {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                                    {{-1, 0, 0}, {1, 0, 0}},
                                    {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
                                    box({0, 0, 0}, {1, 1, 0})};
  for (const Points& a : flat)
    for (const Points& c : flat) {
      const DepthDecision d = decide_depth({a}, {c}, 1e-12);
      EXPECT_FALSE(d.deeper);
      EXPECT_TRUE(d.decided);
      EXPECT_TRUE(std::isfinite(d.upper));
    }
  const Points across = box({0, 0, 0}, {1, 0, 1});
  EXPECT_TRUE(decide_depth({flat[4]}, {across}, 0.9).deeper)
      << "but sheets that cross are deep in each other";
}

TEST(DecideDepth, AnyGuessGivesTheSameDecision) {
  Dice dice(11);
  for (int k = 0; k < 500; ++k) {
    const tests::World w = tests::MovingBodies(k, 2, 1, 0).at(0);
    const bool expected = decide_depth({w.bodies[0]}, {w.bodies[1]}, 0.01).deeper;
    for (int g = 0; g < 4; ++g)
      ASSERT_EQ(decide_depth({w.bodies[0]}, {w.bodies[1]}, 0.01, dice.direction()).deeper, expected) << k;
  }
}

// Asked to spend nothing on bounds that cannot last, the search still decides the same, and both bounds hold.
TEST(DecideDepth, StoppingAtTheDecisionDoesNotChangeIt) {
  for (int k = 0; k < 500; ++k) {
    const tests::World w = tests::MovingBodies(k, 2, 1, 0).at(0);
    const DepthDecision full = decide_depth({w.bodies[0]}, {w.bodies[1]}, 0.01);
    const DepthDecision quick = decide_depth({w.bodies[0]}, {w.bodies[1]}, 0.01, {0, 0, 0}, 1e9);
    ASSERT_EQ(quick.deeper, full.deeper) << k;
    EXPECT_LE(quick.iterations, full.iterations) << k;
    EXPECT_LE(quick.lower, full.upper + 1e-12) << k;
    EXPECT_GE(quick.upper, full.lower - 1e-12) << k;
  }
}

// The corners that enclosed the origin bound the depth from below wherever the bodies have moved since.
TEST(DepthWithin, IsALowerBoundOfTheDepth) {
  Dice dice(12);
  int enclosed = 0, still = 0;
  for (int k = 0; k < 500; ++k) {
    const tests::World w = tests::MovingBodies(k, 2, 1, 0).at(0);
    const Points& a = w.bodies[0];
    Points c = w.bodies[1];
    const dvec3 apex = dice.in_cube(4);
    const DepthDecision met = decide_depth({a}, {c, &apex}, 0.01);
    if (!met.enclosure) continue;  // they do not meet
    ++enclosed;
    EXPECT_GT(met.upper, 0) << k;
    EXPECT_LE(depth_within(*met.enclosure, {a}, {c, &apex}), met.upper + 1e-12) << k;
    for (int step = 0; step < 6; ++step) {
      for (dvec3& p : c) p += dice.in_cube(0.1);
      const double within = depth_within(*met.enclosure, {a}, {c, &apex});
      const DepthDecision now = decide_depth({a}, {c, &apex}, 1e-9);
      EXPECT_LE(within, std::max(now.upper, 0.0) + 1e-12) << k << " step " << step;
      still += within > 0;
    }
  }
  EXPECT_GT(enclosed, 50);
  EXPECT_GT(still, enclosed) << "it is worth keeping only if it lasts";
}

TEST(DepthWithin, FourPointsInOnePlaneEncloseNothing) {
  const Points a = box({0, 0, 0}, {1, 1, 1}), c = {{0, 0, 0}};
  const Enclosure face{{0, 1, 2, 3}, {0, 0, 0, 0}}, one_point{{0, 0, 0, 0}, {0, 0, 0, 0}};
  EXPECT_LE(depth_within(face, {a}, {c}), 0);
  EXPECT_LE(depth_within(one_point, {a}, {c}), 0);
}

TEST(DirectionsTo, ContainTheDirectionsToEveryPoint) {
  Dice dice(3);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 a = dice.in_cube(3), b = dice.in_cube(3), eye = dice.in_cube(4);
    const dvec3 lo = glm::min(a, b), hi = glm::max(a, b);
    const DirectionBox box = directions_to(eye, lo, hi);
    for (int j = 0; j < 20; ++j) {
      const dvec3 p{dice.uniform(lo.x, hi.x), dice.uniform(lo.y, hi.y), dice.uniform(lo.z, hi.z)};
      const dvec3 u = glm::normalize(p - eye);
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(u[c], box.lo[c]) << k;
        ASSERT_LE(u[c], box.hi[c]) << k;
      }
    }
  }
}

// In the middle of a side, and in a corner: the extremes are reached.
TEST(DirectionsTo, AreTight) {
  const DirectionBox front = directions_to({0, 0, 0}, {-1, -1, 2}, {1, 1, 3});
  EXPECT_NEAR(front.lo[2], 2 / std::sqrt(6.0), 1e-6);
  EXPECT_NEAR(front.hi[2], 1, 1e-6);
  EXPECT_NEAR(front.hi[0], 1 / std::sqrt(5.0), 1e-6);
  const DirectionBox around = directions_to({0, 0, 0}, {-1, -1, -1}, {1, 1, 1});
  EXPECT_NEAR(around.lo[1], -1, 1e-6);
  EXPECT_NEAR(around.hi[1], 1, 1e-6);
  EXPECT_FALSE(directions_to({0, 0, 0}, {0, 0, 0}, {0, 0, 0}).empty()) << "a point at the eye";
}

std::vector<DirectionBox> random_boxes(Dice& dice, int count) {
  std::vector<DirectionBox> boxes(count);
  for (DirectionBox& b : boxes) {
    if (dice.below(20) == 0) continue;  // left empty
    const dvec3 c = dice.in_cube(6);
    const dvec3 h = glm::abs(dice.in_cube(0.5));
    b = directions_to({0, 0, 0}, c - h, c + h);
  }
  return boxes;
}

TEST(ExtentTree, FindsWhatATableScanFinds) {
  Dice dice(5);
  for (const int count : {0, 1, 4, 5, 300}) {
    std::vector<DirectionBox> boxes = random_boxes(dice, count);
    ExtentTree tree;
    tree.build(boxes);
    for (int round = 0; round < 3; ++round) {
      for (const DirectionBox& query : random_boxes(dice, 50)) {
        std::vector<int> found, expected;
        tree.query(query, boxes, found);
        for (int i = 0; i < count; ++i)
          if (!query.empty() && !boxes[i].empty() && overlap(query, boxes[i])) expected.push_back(i);
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected);
      }
      for (DirectionBox& b : boxes)
        if (!b.empty()) b.lo[round] -= 0.1f;
      EXPECT_GE(tree.refit(boxes), 1);
    }
  }
}

TEST(SortLine, ValidLineIsLeftAlone) {
  const SortedLine line = sort_line(4, std::vector<OrderEdge>{{0, 1}, {1, 3}, {0, 3}});
  EXPECT_THAT(line.places, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(line.sorted, 0);
}

TEST(SortLine, OnlyTheSpoiledStretchIsSorted) {
  const SortedLine line = sort_line(6, std::vector<OrderEdge>{{4, 2}, {0, 5}});
  EXPECT_THAT(line.places, ElementsAre(0, 1, 3, 4, 2, 5));
  EXPECT_EQ(line.sorted, 3);
}

TEST(SortLine, CyclesAreRuns) {
  const SortedLine line = sort_line(5, std::vector<OrderEdge>{{3, 1}, {1, 3}, {2, 1}});
  EXPECT_THAT(line.places, ElementsAre(0, 2, 1, 3, 4));
  ASSERT_EQ(line.cyclic.size(), 1u);
  EXPECT_EQ(line.cyclic[0].first, 2);
  EXPECT_EQ(line.cyclic[0].count, 2);
}

// A chain of 200,000 that has to be reversed: no recursion, no quadratic step.
TEST(SortLine, LongChainsAreReversed) {
  constexpr int kCount = 200000;
  std::vector<OrderEdge> edges;
  for (int i = 1; i < kCount; ++i) edges.push_back({i, i - 1});
  const SortedLine line = sort_line(kCount, edges);
  for (int i = 0; i < kCount; ++i) ASSERT_EQ(line.places[i], kCount - 1 - i);
}

TEST(SortLine, RandomGraphsAgreeWithTransitiveClosure) {
  Dice dice(17);
  for (int k = 0; k < 3000; ++k) {
    const int count = 1 + dice.below(9), edge_count = dice.below(14);
    std::vector<OrderEdge> edges;
    tests::Relation in_front(count, std::vector<bool>(count, false));
    for (int e = 0; e < edge_count && count > 1; ++e) {
      const int a = dice.below(count), b = (a + 1 + dice.below(count - 1)) % count;
      edges.push_back({a, b});
      in_front[b][a] = true;
    }
    const SortedLine line = sort_line(count, edges);
    VisibilityOrder order;
    std::vector<int> run(count, 0);
    for (const LineRange& r : line.cyclic) run[r.first] = r.count;
    for (int i = 0; i < count; i += std::max(1, run[i]))
      order.groups_back_to_front.emplace_back(line.places.begin() + i,
                                              line.places.begin() + i + std::max(1, run[i]));
    ASSERT_EQ(tests::wrong_with(order, in_front, true), "") << "graph " << k;
    const tests::Relation chains = tests::closure(in_front);
    bool cyclic = false;
    for (int i = 0; i < count; ++i) cyclic = cyclic || chains[i][i];
    const std::vector<int> cycle = short_cycle(count, edges, count);
    ASSERT_EQ(!cycle.empty(), cyclic) << k;
    for (std::size_t i = 0; i < cycle.size(); ++i)
      ASSERT_TRUE(in_front[cycle[(i + 1) % cycle.size()]][cycle[i]]) << k;
  }
}

TEST(ShortCycle, TheShorterOfTwoIsFound) {
  const std::vector<OrderEdge> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 4}};
  EXPECT_THAT(short_cycle(7, edges, 7), ElementsAre(4, 5, 6));
  EXPECT_THAT(short_cycle(2, std::vector<OrderEdge>{{0, 1}}, 2), IsEmpty());
}

}  // namespace
}  // namespace talisman::layers
