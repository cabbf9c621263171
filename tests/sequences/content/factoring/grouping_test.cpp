// SPDX-License-Identifier: Apache-2.0
// The estimates behind the groups against values by hand, and the groups against all groupings that there are.
#include "sequences/content/factoring/grouping.h"

#include <random>

#include <gmock/gmock.h>

#include "sequences/content/factoring/seen_order.h"
#include "tests/sequences/content/factoring/factored_scene.h"

namespace talisman {
namespace {

using sequences::DepthSamples;
using sequences::GroupingData;
using sequences::PieceMotion;
using sequences::Pieces;
using sequences::SpecPair;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using tests::dvec3;
using tests::FactoredScene;

using Groups = std::vector<std::vector<int>>;

/// All that groups are judged by.
struct Looked {
  explicit Looked(const FactoredScene& s)
      : instants(sequences::spread_frames(s.settings.frames, sequences::kMostInstants)),
        pieces(sequences::pieces_of(s.scene, {})),
        motion(s.scene, pieces.layers, s.settings, instants),
        depths(s.scene, pieces.layers, {instants.begin(), instants.end()}, s.settings.view.display_px),
        frames(s.settings.frames) {}
  GroupingData data() const { return {pieces, motion, depths, frames}; }
  Groups alone() const {
    Groups groups;
    for (int i = 0; i < static_cast<int>(pieces.free); ++i) groups.push_back({i});
    return groups;
  }

  std::vector<int> instants;
  Pieces pieces;
  PieceMotion motion;
  DepthSamples depths;
  int frames;
};

TEST(SpreadFrames, AreTheMiddlesOfEqualStretches) {
  EXPECT_THAT(sequences::spread_frames(10, 2), ElementsAre(2, 7));
  EXPECT_THAT(sequences::spread_frames(3, 8), ElementsAre(0, 1, 2));
  EXPECT_THAT(sequences::spread_frames(1, 8), ElementsAre(0));
  EXPECT_THAT(sequences::spread_frames(0, 8), ElementsAre(0));
}

// Squares of 1 m with their corners at |x| = 1 m and 2 m go apart with v: u = x + v t sign(x). The best affine map scales x by
// 1 + v t Σ|x| / Σx² = 1 + v t 3 / 5, and leaves v t (1 - 0.6) at the inner corners, v t (1.2 - 1) at the outer ones. With v = 0.5 px a
// frame that is 0.2 px a frame: 2 px are reached after 10.
TEST(PieceMotion, SquaresThatGoApartServeAsLongAsByHand) {
  FactoredScene s(200);
  s.moves(s.part("left", {-1.5, 0, 0}, -1, 1), {-0.05, 0, 0});
  s.moves(s.part("right", {1.5, 0, 0}, -1, 1), {0.05, 0, 0});
  const PieceMotion motion(s.scene, sequences::pieces_of(s.scene, {}).layers, s.settings, {0});
  EXPECT_NEAR(motion.reuse_frames(std::vector{0, 1}, 0), 10, 0.01);
  // Each by itself is carried exactly by a translation: as long as it is in view.
  EXPECT_GT(motion.reuse_frames(std::vector{0}, 0), 1e3);
}

TEST(PieceMotion, WhatComesIntoViewIsDrawnThen) {
  FactoredScene s(64);
  s.part("still", {0, 0, 0}, -1, 1);
  s.moves(s.part("comes", {6, 0, 0}, -1, 1), {-0.1, 0, 0});  // its edge is on the display after 5 frames
  const PieceMotion motion(s.scene, sequences::pieces_of(s.scene, {}).layers, s.settings, {0});
  EXPECT_FALSE(motion.in_view(1, 0));
  EXPECT_GT(motion.reuse_frames(std::vector{0}, 0), 1e3);
  const double both = motion.reuse_frames(std::vector{0, 1}, 0);
  EXPECT_GE(both, 4);
  EXPECT_LE(both, 8);
  EXPECT_EQ(motion.reuse_frames(std::vector{1}, 0), HUGE_VAL);  // nothing is shown: nothing is drawn
}

TEST(PieceMotion, NothingIsReusedWhereNothingMayBeOff) {
  FactoredScene s;
  s.settings.regulator.thresholds.geometric_px = 0;
  s.part("still", {0, 0, 0});
  s.spins(s.part("turns", {2, 0, 0}), 0.1);
  const PieceMotion motion(s.scene, sequences::pieces_of(s.scene, {}).layers, s.settings, {0});
  EXPECT_EQ(motion.reuse_frames(std::vector{1}, 0), 1);
  EXPECT_EQ(motion.reuse_frames(std::vector{0}, 0), HUGE_VAL);
}

// --- Depths ---

// At z = 0 the display is 10 m wide: a square of 5 m touches a quarter of its 100 × 100 px.
TEST(DepthSamples, TouchedPixelsAndWhoIsInFrontAreThoseByHand) {
  FactoredScene s(1);
  s.part("far", {0, 0, 0}, -1, 1, dvec3(5));
  s.part("near", {0, 0, 5}, -1, 1, dvec3(1));  // half as far: 20 × 20 px, all before the other
  s.part("aside", {4, 4, 0}, -1, 1, dvec3(1));
  const Looked looked(s);
  EXPECT_NEAR(looked.depths.touched_px(0, 0), 2500, 60);
  EXPECT_NEAR(looked.depths.touched_px(1, 0), 400, 25);
  EXPECT_NEAR(looked.depths.in_front(1, 0), 400, 25);
  EXPECT_EQ(looked.depths.in_front(0, 1), 0u);
  EXPECT_EQ(looked.depths.in_front(0, 2) + looked.depths.in_front(2, 0), 0u);
  EXPECT_EQ(looked.depths.mutual_frames(0, 1), 0u);
  EXPECT_NEAR(looked.depths.nearest_m(1), 5, 1e-5);
}

// A floor of two triangles that reaches behind the eye is seen as far as it is before it.
TEST(DepthSamples, WhatReachesBehindTheEyeIsCutThere) {
  FactoredScene s(1);
  const int floor = s.part("floor", {0, -1, 0}, -1, 1, dvec3(200));
  s.scene.nodes[floor].local.rotation = glm::angleAxis(-M_PI / 2, dvec3(1, 0, 0));
  const Looked looked(s);
  EXPECT_NEAR(looked.depths.touched_px(0, 0), 5000, 300);  // below the horizon, which is in the middle
}

TEST(DepthSamples, BodiesThatCrossLieBeforeEachOtherAtOnce) {
  FactoredScene s(1);
  const int a = s.part("a", {0, 0, 0}, -1, 1, dvec3(4)), b = s.part("b", {0, 0, 0}, -1, 1, dvec3(4));
  s.scene.nodes[a].local.rotation = glm::angleAxis(0.5, dvec3(0, 1, 0));
  s.scene.nodes[b].local.rotation = glm::angleAxis(-0.5, dvec3(0, 1, 0));
  const Looked looked(s);
  EXPECT_EQ(looked.depths.mutual_frames(0, 1), 1u);
  EXPECT_THAT(sequences::grouped(looked.data(), {}, looked.alone()),
              ElementsAre(ElementsAre(0, 1)));  // one sprite
}

// --- Order ---

TEST(SeenOrder, PairsThatWouldGoRoundAreLeftOut) {
  FactoredScene s(1);
  s.part("far", {0, 0, 0}, -1, 1, dvec3(4));
  s.part("middle", {0, 0, 1}, -1, 1, dvec3(3));
  s.part("near", {0, 0, 2}, -1, 1, dvec3(2));
  const Looked looked(s);
  const Groups layers{{0}, {1}, {2}};
  const std::vector<layers::OrderGroup> groups(3, layers::OrderGroup::Normal);
  const auto pairs =
      sequences::seen_order(looked.depths, layers, groups, std::vector<SpecPair>{{0, 1}, {0, 2}, {1, 2}});
  ASSERT_EQ(pairs.size(), 3u);
  for (const auto& seen : pairs) {
    EXPECT_LT(seen.pair.first, seen.pair.second);  // behind, front: by their depths
    EXPECT_EQ(seen.hidden, 0);
  }
}

TEST(SeenOrder, GroupsOfTheAuthorAreNotOverruled) {
  FactoredScene s(1);
  s.part("far", {0, 0, 0}, -1, 1, dvec3(4));
  s.part("near", {0, 0, 1}, -1, 1, dvec3(3));
  const Looked looked(s);
  const std::vector<layers::OrderGroup> groups{layers::OrderGroup::Foreground, layers::OrderGroup::Normal};
  EXPECT_THAT(sequences::seen_order(looked.depths, Groups{{0}, {1}}, groups, std::vector<SpecPair>{{0, 1}}),
              IsEmpty());
}

// --- Against all groupings ---

double work_ms(const GroupingData& data, const Groups& groups) {
  double sum = 0;
  for (const std::vector<int>& group : groups) sum += sequences::work_of(data, group).ms;
  return sum;
}

/// The least work of all ways to put pieces i … into the groups so far.
double least_work_ms(const GroupingData& data, int i, Groups& groups) {
  if (i == static_cast<int>(data.pieces.free)) return work_ms(data, groups);
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    groups[k].push_back(i);
    least = std::min(least, least_work_ms(data, i + 1, groups));
    groups[k].pop_back();
  }
  groups.push_back({i});
  least = std::min(least, least_work_ms(data, i + 1, groups));
  groups.pop_back();
  return least;
}

// Five cubes that drift and turn about each other at random, all 52 groupings: joining two at a time finds one that costs no more
// than a fifth above the best, and in most scenes the best.
TEST(Grouping, CostsNoMoreThanAFifthAboveTheBestOfAllGroupings) {
  std::mt19937 random(7);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() / 4294967296.0); };
  int best = 0, scenes = 0;
  for (int seed = 0; seed < 12; ++seed) {
    FactoredScene s(32);
    for (int i = 0; i < 5; ++i) {
      // Apart in depth, so that none crosses another.
      const int at = s.part("c" + std::to_string(i), {uniform(-2, 2), uniform(-2, 2), -3.0 * i});
      if (i % 2 == 0)
        s.spins(at, uniform(0, 0.2));
      else
        s.moves(at, {uniform(-0.05, 0.05), uniform(-0.05, 0.05), uniform(-0.05, 0)});
    }
    const Looked looked(s);
    Groups none;
    const double least = least_work_ms(looked.data(), 0, none);
    const double found = work_ms(looked.data(), sequences::grouped(looked.data(), {}, looked.alone()));
    ASSERT_GT(least, 0);
    EXPECT_LE(found, 1.2 * least) << seed;
    EXPECT_GE(found, least * (1 - 1e-9)) << seed;
    best += found <= least * (1 + 1e-9);
    ++scenes;
  }
  EXPECT_GE(best, scenes / 2);
}

}  // namespace
}  // namespace talisman
