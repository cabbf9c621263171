// SPDX-License-Identifier: Apache-2.0
// The visibility sort over time: what stays, what is released, what is asked again.
#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/visibility.h"
#include "tests/layers/visibility_oracle.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using tests::box;
using tests::Dice;
using tests::Points;
using tests::World;

constexpr dvec3 kFixedEye{0, 0, 10};

VisibilityOrder frame(VisibilitySorter& sorter, const std::vector<Points>& bodies) {
  return sorter.sort(kFixedEye, World{kFixedEye, bodies}.occluders());
}

// Neither is before the other; they only get nearer by turns. An order by distance would flicker.
TEST(VisibilityMotion, EqualsKeepTheirOrder) {
  VisibilitySorter sorter;
  for (int k = 0; k < 20; ++k) {
    const double z = k % 2 ? 0.5 : -0.5;
    const VisibilityOrder o = frame(sorter, {box({-3, 0, z}, {1, 1, 1}), box({3, 0, -z}, {1, 1, 1})});
    EXPECT_THAT(o.order, ElementsAre(0, 1));
    EXPECT_EQ(o.counters.swaps, 0);
  }
}

TEST(VisibilityMotion, NewOrderMovesOnlyWhatMust) {
  VisibilitySorter sorter;
  std::vector<Points> bodies;
  for (int i = 0; i < 6; ++i) bodies.push_back(box({4.0 * i, 0, -1.0 * i}, {1, 1, 1}));
  EXPECT_THAT(frame(sorter, bodies).order, ElementsAre(5, 4, 3, 2, 1, 0));
  bodies[3] = box({4, 0, 3}, {1, 1, 1});  // from between its neighbours in the line to before layer 1
  const VisibilityOrder o = frame(sorter, bodies);
  EXPECT_THAT(o.order, ElementsAre(5, 4, 2, 1, 3, 0));
  EXPECT_EQ(o.counters.swaps, 3);
  EXPECT_EQ(o.counters.sorted, 3);
}

// One layer flies through another: merged while they meet and `release_frames` longer, in one go.
TEST(VisibilityMotion, CrossingLayersMergeOnceAndSplitOnce) {
  for (const int release : {0, 1, 4}) {
    VisibilitySorter sorter({1e-3, release});
    std::string seen;
    for (int k = 0; k < 40; ++k) {
      const VisibilityOrder o =
          frame(sorter, {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -8.1 + 0.4 * k}, {1, 1, 1})});
      if (o.merged.empty()) {
        seen += o.order.front() == 1 ? 'b' : 'f';
      } else {
        const MergedComponent& m = o.merged[0];
        seen += m.reason == MergedComponent::Reason::Held ? static_cast<char>('0' + m.absent_frames) : 'm';
      }
    }
    std::string expected(16, 'b');
    expected += std::string(10, 'm');
    for (int k = 1; k <= release; ++k) expected += static_cast<char>('0' + k);
    expected += std::string(40 - expected.size(), 'f');
    EXPECT_EQ(seen, expected);
  }
}

TEST(VisibilityMotion, CycleThatBlinksStaysMerged) {
  VisibilitySorter sorter({1e-3, 2});
  for (int k = 0; k < 30; ++k) {
    const double z = k % 3 == 0 ? 1.9 : 2.1;
    const VisibilityOrder o = frame(sorter, {box({0, 0, 0}, {1, 1, 1}), box({0, 0, z}, {1, 1, 1})});
    ASSERT_EQ(o.merged.size(), 1u) << k;
    EXPECT_EQ(o.merged[0].absent_frames, k % 3);
  }
}

// What lies between two held layers cannot be drawn between them: it is merged too, and released with them.
TEST(VisibilityMotion, LayerBetweenHeldOnesIsHeldWithThem) {
  VisibilitySorter sorter({1e-3, 2});
  const Points still = box({0, 0, 0}, {1, 1, 1}), aside = box({9, 0, 0}, {1, 1, 1});
  frame(sorter, {still, box({0, 0, 1}, {1, 1, 1}), aside});
  const Points away = box({0, 0, 5}, {1, 1, 1}), between = box({0, 0, 2.5}, {1, 1, 1});
  for (int k = 1; k <= 2; ++k) {
    const VisibilityOrder o = frame(sorter, {still, away, between});
    ASSERT_EQ(o.merged.size(), 1u);
    EXPECT_THAT(o.merged[0].layers, ElementsAre(0, 1, 2));
    EXPECT_EQ(o.merged[0].absent_frames, k);
    EXPECT_THAT(o.merged[0].cycle, IsEmpty());
  }
  EXPECT_THAT(frame(sorter, {still, away, between}).groups_back_to_front,
              ElementsAre(ElementsAre(0), ElementsAre(2), ElementsAre(1)));
}

TEST(VisibilityMotion, HeldCycleEndsWithItsLayers) {
  VisibilitySorter sorter({1e-3, 100});
  const Points a = box({0, 0, 0}, {1, 1, 1}), b = box({0, 0, 1}, {1, 1, 1});
  EXPECT_EQ(frame(sorter, {a, b}).merged.size(), 1u);
  EXPECT_THAT(frame(sorter, {a}).merged, IsEmpty());
  EXPECT_THAT(frame(sorter, {a, box({0, 0, 5}, {1, 1, 1})}).merged, IsEmpty()) << "it has come anew";
}

TEST(VisibilityMotion, NothingIsAskedTwiceAtRest) {
  const World world = tests::MovingBodies(3, 40, 4, 0).at(0);
  VisibilitySorter sorter;
  const VisibilityOrder first = sorter.sort(world.eye, world.occluders());
  EXPECT_EQ(first.counters.queries, 40);
  EXPECT_GT(first.counters.exact_tests, 0);
  for (int k = 0; k < 3; ++k) {
    const VisibilityOrder o = sorter.sort(world.eye, world.occluders());
    EXPECT_EQ(o.groups_back_to_front, first.groups_back_to_front);
    EXPECT_EQ(o.counters.queries + o.counters.exact_tests + o.counters.swaps, 0);
    EXPECT_EQ(o.counters.edges, first.counters.edges);
  }
}

// Tiles that share their edges have no gap but for the tolerance, 2 mm here. What rests needs none: only the eye moves, by
// 30 mm in all, and stays on its side of all planes between them.
TEST(VisibilityMotion, TilesAtRestAreNotAskedAgainWhileTheEyeMoves) {
  std::vector<Points> tiles;
  for (int i = 0; i < 6; ++i) tiles.push_back(box({2.0 * i, 0, 0}, {1, 0.2, 1}));
  VisibilitySorter sorter;
  for (int k = 0; k < 30; ++k) {
    const dvec3 eye(-6, 0.001 * k, 0);
    const World world{eye, tiles};
    const VisibilityOrder order = sorter.sort(eye, world.occluders());
    EXPECT_THAT(order.order, ElementsAre(5, 4, 3, 2, 1, 0));
    if (k == 0)
      EXPECT_GT(order.counters.exact_tests, 0);
    else
      EXPECT_EQ(order.counters.exact_tests, 0) << k;
  }
}

// A plan that looks ahead sorts a copy; the sorter that it was copied from must not notice.
TEST(VisibilityMotion, CopiesGoTheirOwnWay) {
  const tests::MovingBodies bodies(9, 30, 3, 0.05);
  VisibilitySorter one, other;
  const auto step = [&](VisibilitySorter& s, int k) {
    const World world = bodies.at(k);
    return s.sort(world.eye, world.occluders()).groups_back_to_front;
  };
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(step(one, k), step(other, k));
    VisibilitySorter ahead = one;
    for (int j = 1; j <= 5; ++j) step(ahead, k + j);
    VisibilitySorter assigned;
    assigned = ahead;
    EXPECT_EQ(step(assigned, k), step(ahead, k));
  }
}

TEST(VisibilityMotion, LayersMayChangeGroupAndBodies) {
  VisibilitySorter sorter;
  const Points near = box({0, 0, 0}, {1, 1, 1}), far = box({0, 0, -5}, {1, 1, 1}),
               nearest = box({0, 0, 5}, {1, 1, 1});
  std::vector<Occluder> layers = {{0, OrderGroup::Normal, {near}}, {1, OrderGroup::Normal, {far}}};
  EXPECT_THAT(sorter.sort(kFixedEye, layers).order, ElementsAre(1, 0));
  layers[0].group = OrderGroup::Background;
  EXPECT_THAT(sorter.sort(kFixedEye, layers).order, ElementsAre(0, 1));
  layers[0].group = OrderGroup::Normal;
  layers[1].bodies = {far, nearest};
  EXPECT_EQ(sorter.sort(kFixedEye, layers).merged.size(), 1u)
      << "the second is behind the first and before it";
  layers[1].bodies = {nearest};
  VisibilityOrder o;
  for (int k = 0; k < 6; ++k) o = sorter.sort(kFixedEye, layers);
  EXPECT_THAT(o.groups_back_to_front, ElementsAre(ElementsAre(0), ElementsAre(1)));
}

// Layers come, go, teleport, break and change their number of points; every frame must be as good as a first.
TEST(VisibilityMotion, ComingAndGoingAgreesWithBruteForce) {
  int checked = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Dice dice(seed);
    VisibilitySorter sorter({1e-3, 0});
    std::map<int, Points> there;
    dvec3 eye = dice.in_cube(6);
    for (int k = 0; k < 40; ++k) {
      const int id = dice.below(9);
      if (dice.below(3) == 0)
        there.erase(id);
      else
        there[id] = tests::MovingBodies(seed * 1000 + k, 1, 3, 0).at(0).bodies[0];
      if (dice.below(8) == 0) eye = dice.in_cube(6);
      for (auto& [layer, points] : there)
        for (dvec3& p : points) p += dvec3{0.01, 0.002 * layer, -0.01};
      World world{eye, {}};
      std::vector<Occluder> layers;
      std::map<int, int> index;
      for (auto& [layer, points] : there) {
        index[layer] = static_cast<int>(world.bodies.size());
        world.bodies.push_back(points);
        layers.push_back({layer, OrderGroup::Normal, {points}});
      }
      VisibilityOrder order = sorter.sort(eye, layers);
      for (auto& group : order.groups_back_to_front)
        for (int& layer : group) layer = index.at(layer);
      const tests::Relation relation = tests::slow_relation(world, 1e-3);
      if (relation.empty()) continue;
      ++checked;
      ASSERT_EQ(tests::wrong_with(order, relation, true), "") << "seed " << seed << ", frame " << k;
    }
  }
  EXPECT_GT(checked, 1500);
}

/// Distance at which the ray meets the box, or infinity.
double hit(const dvec3& from, const dvec3& along, const dvec3& centre, const dvec3& half) {
  double enter = 0, leave = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const double a = (centre[k] - half[k] - from[k]) / along[k],
                 b = (centre[k] + half[k] - from[k]) / along[k];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : HUGE_VAL;
}

// What the order is for: along every ray the last sprite drawn must be the first surface met, unless the two
// are in one sprite.
TEST(VisibilityMotion, LastDrawnIsFirstMetAlongEveryRay) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Dice dice(seed);
    std::vector<dvec3> centres, halves;
    std::vector<Points> bodies;
    for (int i = 0; i < 25; ++i) {
      centres.push_back(dice.in_cube(5)), halves.push_back(glm::abs(dice.in_cube(0.8)) + 0.1);
      bodies.push_back(box(centres[i], halves[i]));
    }
    // Touching bodies may hide each other by a thousandth; rays of no tolerance must not look there.
    VisibilitySorter sorter({0, 0});
    const VisibilityOrder o = sorter.sort(kFixedEye, World{kFixedEye, bodies}.occluders());
    for (int r = 0; r < 2000; ++r) {
      const dvec3 along = glm::normalize(dice.in_cube(5) - kFixedEye);
      int drawn_last = -1, met_first = -1;
      double nearest = HUGE_VAL;
      for (int g = 0; g < static_cast<int>(o.groups_back_to_front.size()); ++g)
        for (const int layer : o.groups_back_to_front[g]) {
          const double at = hit(kFixedEye, along, centres[layer], halves[layer]);
          if (at == HUGE_VAL) continue;
          drawn_last = g;
          if (at < nearest) nearest = at, met_first = g;
        }
      compared += met_first >= 0;
      ASSERT_EQ(drawn_last, met_first) << "seed " << seed << ", ray " << r;
    }
  }
  EXPECT_GT(compared, 10000);
}

}  // namespace
}  // namespace talisman::layers
