// SPDX-License-Identifier: Apache-2.0
// What lies behind all else, of walls with cubes in front of them.
#include "sequences/content/factoring/backdrops.h"

#include <gmock/gmock.h>

#include "tests/sequences/content/factoring/factored_scene.h"

namespace talisman {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using tests::FactoredScene;

/// A wall of two halves in the plane z = 0, which share an edge, and six cubes of 1 m that are sunk into it by 0.2 m.
FactoredScene wall_with_cubes() {
  FactoredScene s;
  s.part("left", {-2, 0, 0}, -1, 1, {4, 8, 1});
  s.part("right", {2, 0, 0}, -1, 1, {4, 8, 1});
  for (int i = 0; i < 6; ++i)
    s.part("cube" + std::to_string(i), {2.0 * (i % 3) - 2, i < 3 ? -2.0 : 2.0, 0.3});
  return s;
}

std::vector<std::string> names_behind(const FactoredScene& s) {
  const sequences::Pieces pieces = sequences::pieces_of(s.scene, {});
  const sequences::DepthSamples depths(s.scene, pieces.layers, {0.0}, s.settings.view.display_px);
  const std::vector<bool> behind = sequences::pieces_behind(s.scene, pieces, depths);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < behind.size(); ++i)
    if (behind[i]) names.push_back(s.scene.parts[pieces.layers[i].parts.front()].name);
  return names;
}

TEST(Backdrops, WallBehindCubesIsOneBodyOfItsHalves) {
  EXPECT_THAT(names_behind(wall_with_cubes()), UnorderedElementsAre("left", "right"));
}

// What the wall hides is no last thing itself: something lies behind it. 0.2 m are 0.04 m² of the 6.04 m² at which wall and
// cubes are seen, 0.7 %; 0.6 m are 0.36 of 6.36 m², 5.7 %. The limit is 1 %.
TEST(Backdrops, WallMayHideALittle) {
  for (const double size : {0.2, 0.6}) {
    FactoredScene s = wall_with_cubes();
    s.part("hidden", {0, 0, -0.1}, -1, 0, {size, size, 0.1});
    s.part("deep", {0, 0, -3}, -1, 0, {size, size, 0.1});
    if (size < 0.5)
      EXPECT_THAT(names_behind(s), UnorderedElementsAre("left", "right", "deep"));
    else
      EXPECT_THAT(names_behind(s), ElementsAre("deep"));
  }
}

// Ordered by its bounds it would be one with the wall.
TEST(Backdrops, WhatIsBeforeTheWallAloneIsNotBehind) {
  FactoredScene s = wall_with_cubes();
  s.part("lamp", {0, 0, 0.3}, -1, 0, {0.3, 0.3, 0.3});
  EXPECT_THAT(names_behind(s), UnorderedElementsAre("left", "right"));
}

// The sky touches nobody and is in front of nothing; the wall is in front of the sky alone.
TEST(Backdrops, WhatLiesBehindIsNoObstacleToWhatIsBeforeIt) {
  FactoredScene s = wall_with_cubes();
  s.part("sky", {0, 0, -50}, -1, 1, {100, 100, 1});
  EXPECT_THAT(names_behind(s), UnorderedElementsAre("left", "right", "sky"));
}

TEST(Backdrops, OneBodyAmongFewOthersIsNoBackdrop) {
  FactoredScene s;
  s.part("near", {0, 0, 1});
  s.part("beside", {4, 4, 0});
  EXPECT_THAT(names_behind(s), IsEmpty());
}

TEST(Backdrops, GroupsAreCutIntoBothSides) {
  EXPECT_THAT(sequences::cut_by({true, false, true, false}, {{0, 1, 2}, {3}}),
              UnorderedElementsAre(ElementsAre(0, 2), ElementsAre(1), ElementsAre(3)));
}

// Bounds know no order between the wall and what is sunk into it, so they would be drawn together in each of the 24 frames:
// some 6,400 texels each time, of which the cubes are 6 · 15 · 12.
TEST(Backdrops, WallBehindCubesThatTurnIsPutIntoTheBackground) {
  FactoredScene s = wall_with_cubes();
  for (int i = 0; i < 6; ++i) s.spins(s.scene.parts[2 + i].node, 0.3 + 0.1 * i);
  const sequences::Factoring chosen = s.study().chosen;
  ASSERT_TRUE(chosen.has_background);
  for (std::size_t i = 0; i < chosen.specs.size(); ++i) {
    const std::string part = s.parts_of(chosen)[i].front();
    EXPECT_EQ(chosen.specs[i].group == layers::OrderGroup::Background, part == "left" || part == "right")
        << part;
  }
  EXPECT_LT(chosen.plan.pixels, 0.5 * 24 * 6400);
}

// At rest all is drawn once, whatever the layers: nothing is worth a picture in which the wall hides nothing.
TEST(Backdrops, WhereItSavesNothingThereIsNone) {
  EXPECT_FALSE(wall_with_cubes().study().chosen.has_background);
}

}  // namespace
}  // namespace talisman
