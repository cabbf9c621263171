// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/layer.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;

using Boxes = std::vector<WorldBounds>;

std::vector<Layer> layers_for(const Boxes& boxes) {
  std::vector<Layer> layers(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) layers[i].id = static_cast<int>(i);
  return layers;
}

std::vector<int> order(const dvec3& eye, const Boxes& boxes) {
  return back_to_front(eye, layers_for(boxes), boxes);
}

void expect_each_once(const std::vector<int>& ids, std::size_t count) {
  std::vector<int> sorted = ids, all(count);
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
}

WorldBounds box(const dvec3& centre, const dvec3& half) { return {centre - half, centre + half}; }

TEST(BackToFront, NothingIsNothing) { EXPECT_TRUE(order({0, 0, 0}, {}).empty()); }

TEST(BackToFront, RowIsOrderedFromEitherEnd) {
  const Boxes row = {box({0, 0, 0}, {1, 1, 1}), box({0, 0, -3}, {1, 1, 1}), box({0, 0, -6}, {1, 1, 1})};
  EXPECT_THAT(order({0, 0, 9}, row), ElementsAre(2, 1, 0));
  EXPECT_THAT(order({0, 0, -19}, row), ElementsAre(0, 1, 2));
}

// A long wall's centre and farthest point say nothing: the plane between it and the crate does.
TEST(BackToFront, LongThingsGoByThePlaneBetween) {
  const Boxes boxes = {box({40, 0, 0}, {50, 2, 0.1}), box({0, 0, -1}, {0.5, 0.5, 0.5})};
  EXPECT_THAT(order({0, 0, 3}, boxes), ElementsAre(1, 0)) << "the crate is behind the wall";
  EXPECT_THAT(order({0, 0, -9}, boxes), ElementsAre(0, 1)) << "and in front of it from there";
}

TEST(BackToFront, GroupsComeBeforeDepth) {
  const Boxes boxes = {box({0, 0, -1}, {0.1, 0.1, 0.1}), box({0, 0, -9}, {1, 1, 1}),
                       box({0, 0, -5}, {1, 1, 1})};
  auto layers = layers_for(boxes);
  layers[0].group = OrderGroup::Background;
  layers[1].group = OrderGroup::Foreground;
  EXPECT_THAT(back_to_front({0, 0, 0}, layers, boxes), ElementsAre(0, 2, 1));
}

TEST(BackToFront, TouchingBoxesAreSeparatedByTheirCommonFace) {
  const Boxes boxes = {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}}};
  EXPECT_THAT(order({0.5, 0.5, 5}, boxes), ElementsAre(0, 1));
  EXPECT_THAT(order({0.5, 0.5, -5}, boxes), ElementsAre(1, 0));
}

TEST(BackToFront, IdenticalBoxesGoById) {
  const Boxes boxes(5, box({0, 0, -5}, {1, 1, 1}));
  EXPECT_THAT(order({0, 0, 0}, boxes), ElementsAre(0, 1, 2, 3, 4));
}

// A poster on a wall: two flat boxes in one plane overlap, though either looks as if the plane separated
// them.
TEST(BackToFront, FlatBoxInThePlaneOfALargerOneIsInFront) {
  const WorldBounds poster = box({1, 1, 0}, {0.5, 0.5, 0}), wall = box({0, 0, 0}, {5, 5, 0});
  EXPECT_THAT(order({0, 0, 4}, {poster, wall}), ElementsAre(1, 0));
  EXPECT_THAT(order({0, 0, 4}, {wall, poster}), ElementsAre(0, 1));
}

TEST(BackToFront, FlatBoxesOneBehindTheOther) {
  const Boxes boxes = {box({0, 0, -1}, {5, 5, 0}), box({0, 0, -2}, {1, 1, 0}), box({0, 0, -3}, {9, 9, 0})};
  EXPECT_THAT(order({0, 0, 0}, boxes), ElementsAre(2, 1, 0));
}

// By the nearest point a terrain under the eye would be drawn last, over everything that stands on it.
TEST(BackToFront, WhatContainsComesBeforeItsContent) {
  const WorldBounds terrain = box({0, 0, 0}, {100, 3, 100}), house = box({0, 0, -20}, {2, 2, 2});
  for (const dvec3& eye : {dvec3{0, 1, 0}, dvec3{0, 50, 0}, dvec3{0, 2, 150}})
    EXPECT_THAT(order(eye, {house, terrain}), ElementsAre(1, 0));
}

// Bounds of neighbours often overlap by a little: a seam row, a foot sunk into the ground.
TEST(BackToFront, SlightOverlapStillIsAPlane) {
  const WorldBounds near_strip{{-50, 0, -10.5}, {50, 3, 0}}, far_strip{{-50, 0, -20}, {50, 3, -10}};
  EXPECT_THAT(order({0, 2, 5}, {near_strip, far_strip}), ElementsAre(1, 0));
  EXPECT_THAT(order({0, 2, -30}, {near_strip, far_strip}), ElementsAre(0, 1));
  const WorldBounds ground = box({0, -0.2, 0}, {50, 0.2, 50}), table{{-1, -0.1, -1}, {1, 1, 1}};
  EXPECT_THAT(order({0, 5, 0}, {ground, table}), ElementsAre(0, 1));
}

TEST(BackToFront, EmptyBoundsComeFirstInTheirGroup) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Boxes boxes = {box({0, 0, -9}, {1, 1, 1}), {}, {{nan, nan, nan}, {nan, nan, nan}}};
  EXPECT_THAT(order({0, 0, 0}, boxes), ElementsAre(1, 2, 0));
}

TEST(BackToFront, EyeInsideAllBoxesGivesAnOrder) {
  Boxes boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back(box({0, 0, 0}, {1.0 + i % 5, 1.0 + i % 3, 1.0 + i % 7}));
  const auto ids = order({0.1, 0.2, -0.3}, boxes);
  expect_each_once(ids, boxes.size());
  EXPECT_EQ(ids.back(), 0) << "the smallest is inside all others";
}

TEST(BackToFront, InfiniteBoxesAndEyeWithoutNumbersGiveAnOrder) {
  const double inf = HUGE_VAL, nan = std::numeric_limits<double>::quiet_NaN();
  const Boxes boxes = {
      {{-inf, -inf, -inf}, {inf, inf, inf}}, box({0, 0, -3}, {1, 1, 1}), {{-inf, 0, 0}, {inf, 0, 0}}};
  for (const dvec3& eye : {dvec3{0, 0, 0}, dvec3{nan, 0, 0}, dvec3{0, inf, 0}, dvec3{1e300, -1e300, 0}})
    expect_each_once(order(eye, boxes), boxes.size());
}

// Three bars, each before the next and behind the one after that: no order is right, but what is behind and
// in front of the knot must not suffer from it.
TEST(BackToFront, CycleIsKeptTogether) {
  // From (9, 9, 9) each bar has an end towards the eye beside the next bar's long side.
  const Boxes boxes = {{{0, 2, 0}, {3, 3, 1}},
                       {{0, 0, 2}, {1, 3, 3}},
                       {{2, 0, 0}, {3, 1, 3}},
                       {{-9, -9, -9}, {-5, 9, 9}},
                       {{5, 5, 5}, {6, 6, 6}}};
  for (int i = 0; i < 3; ++i)  // it is a knot: each pair alone has an order
    EXPECT_THAT(order({9, 9, 9}, {boxes[i], boxes[(i + 1) % 3]}), ElementsAre(0, 1)) << i;
  const auto ids = order({9, 9, 9}, boxes);
  expect_each_once(ids, boxes.size());
  EXPECT_EQ(ids.front(), 3) << "the wall behind";
  EXPECT_EQ(ids.back(), 4) << "the cube in front";
}

/// Entry distance of a ray into a box; infinite if it misses.
double entry(const dvec3& eye, const dvec3& direction, const WorldBounds& b) {
  double in = 0, out = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const double t0 = (b.lo[k] - eye[k]) / direction[k], t1 = (b.hi[k] - eye[k]) / direction[k];
    in = std::max(in, std::min(t0, t1));
    out = std::min(out, std::max(t0, t1));
  }
  return in < out ? in : HUGE_VAL;
}

bool overlap(const WorldBounds& a, const WorldBounds& b) {
  for (int k = 0; k < 3; ++k)
    if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k]) return false;
  return true;
}

/// in_front[a][b]: some ray through sample points of the boxes meets b before a.
std::vector<std::vector<bool>> seen_in_front(const dvec3& eye, const Boxes& boxes) {
  std::vector<std::vector<bool>> front(boxes.size(), std::vector<bool>(boxes.size(), false));
  for (const WorldBounds& through : boxes)
    for (int sample = 0; sample < 125; ++sample) {
      const dvec3 share = (dvec3{sample % 5, sample / 5 % 5, sample / 25} + 0.5) / 5.0;
      const dvec3 direction = through.lo + share * (through.hi - through.lo) - eye;
      for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = 0; b < boxes.size(); ++b) {
          const double ta = entry(eye, direction, boxes[a]), tb = entry(eye, direction, boxes[b]);
          if (ta < HUGE_VAL && tb < ta) front[a][b] = true;
        }
    }
  return front;
}

bool cyclic(std::vector<std::vector<bool>> front) {
  const std::size_t n = front.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (front[i][k] && front[k][j]) front[i][j] = true;
  for (std::size_t i = 0; i < n; ++i)
    if (front[i][i]) return true;
  return false;
}

// The oracle: rays. Among boxes that do not overlap, whatever a ray meets first must be drawn last.
TEST(BackToFront, AgreesWithRaysAmongDisjointBoxes) {
  constexpr unsigned kSeed = 1997;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(-5, 5), size(0.05, 3);
  int checked = 0;
  for (int trial = 0; trial < 120; ++trial) {
    Boxes boxes;
    for (int tries = 0; tries < 60 && boxes.size() < 12; ++tries) {
      const auto candidate =
          box({place(random), place(random), place(random)}, {size(random), size(random), size(random)});
      if (std::none_of(boxes.begin(), boxes.end(), [&](const auto& b) { return overlap(b, candidate); }))
        boxes.push_back(candidate);
    }
    const dvec3 eye{place(random) * 1.5, place(random) * 1.5, place(random) * 1.5};
    const auto front = seen_in_front(eye, boxes);
    if (cyclic(front)) continue;
    const auto ids = order(eye, boxes);
    expect_each_once(ids, boxes.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
      for (std::size_t j = i + 1; j < ids.size(); ++j) {
        ASSERT_FALSE(front[ids[j]][ids[i]]) << "trial " << trial << ": " << ids[i] << " hides " << ids[j];
        checked += front[ids[i]][ids[j]];
      }
  }
  EXPECT_GT(checked, 1000) << "the test must have seen occlusions";
}

TEST(BackToFront, DoesNotDependOnTheOrderOfItsInput) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-5, 5), size(0.5, 3);
  Boxes boxes;
  for (int i = 0; i < 60; ++i)
    boxes.push_back(
        box({place(random), place(random), place(random)}, {size(random), size(random), size(random)}));
  auto layers = layers_for(boxes);
  const auto expected = back_to_front({1, 2, 9}, layers, boxes);
  for (int trial = 0; trial < 10; ++trial) {
    std::shuffle(layers.begin(), layers.end(), random);
    Boxes shuffled;
    for (const Layer& layer : layers) shuffled.push_back(boxes[layer.id]);
    EXPECT_EQ(back_to_front({1, 2, 9}, layers, shuffled), expected);
  }
}

// Quadratic, but linear in memory: a city of ten thousand layers.
TEST(BackToFront, TenThousandLayersAreSorted) {
  Boxes boxes;
  for (int z = 0; z < 100; ++z)
    for (int x = 0; x < 100; ++x) boxes.push_back(box({3.0 * x, 0, -3.0 * z}, {1, 1.0 + (x * z) % 5, 1}));
  const auto ids = order({150, 2, 10}, boxes);
  expect_each_once(ids, boxes.size());
  std::vector<int> position(boxes.size());
  for (std::size_t i = 0; i < ids.size(); ++i) position[ids[i]] = static_cast<int>(i);
  for (int z = 0; z + 1 < 100; ++z)
    for (int x = 0; x < 100; ++x)
      ASSERT_LT(position[100 * (z + 1) + x], position[100 * z + x]) << "the house behind is drawn before";
}

}  // namespace
}  // namespace talisman::layers
