// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/member_levels.h"

#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "layers/lod/levels.h"

namespace talisman::tests {
namespace {

using layers::dmat4;
using layers::dvec3;
using layers::MemberLevels;

/// Cubes of 1 m, each with levels of 1000, 500 and 100 triangles that are 0, 0.1 and 0.5 m off, in one layer: 10 m ahead of
/// the eye, far to the right, and behind it. The display has 100 × 100 px and a field of view of 90°, so f is 50 px.
struct Cubes {
  layers::Scene scene;
  layers::Layer layer;
  layers::LayerState now;
  layers::SpritePlacement placement;

  Cubes() {
    layers::LevelSet levels;
    levels.ladders = {{{{0, 1000, 500, 1, 0.0}, {1, 500, 250, 1, 0.1}, {2, 100, 50, 1, 0.5}}}};
    layers::MeshBox box;
    for (int k = 0; k < 3; ++k) box.rest.lo[k] = -0.5, box.rest.hi[k] = 0.5;
    levels.boxes = {box};
    for (int i = 0; i < 3; ++i) {
      layers::Part part;
      part.mesh = 0;
      scene.parts.push_back(part);
      levels.parts.push_back({i, 10 + i, 20 + i});
      layer.parts.push_back(i);
    }
    layer.polygons = 3000;
    scene.levels = std::make_shared<const layers::LevelSet>(std::move(levels));
    for (const dvec3& at : {dvec3(0, 0, -10), dvec3(100, 0, -10), dvec3(0, 0, 10)})
      now.world_from_part.push_back(glm::translate(dmat4(1), at));
    now.camera.fov_y_rad = std::numbers::pi / 2;
    now.view.display_px = {100, 100};
    now.nearest_w_m = 9.5;
    placement.size_px = {100, 100};
  }
  MemberLevels at_rung(int rung) const {
    return layers::ShownMembers(scene, layer, now, placement).at_rung(rung);
  }
};

using Parts = std::vector<int>;

TEST(MemberLevelsByHand, APartOutsideIsNotDrawnAndTheOtherIsAtTheCoarsestLevelWithinTheError) {
  const Cubes cubes;
  EXPECT_TRUE(layers::has_member_levels(cubes.scene, cubes.layer));
  EXPECT_EQ(cubes.at_rung(0).parts, Parts({0}));
  EXPECT_EQ(cubes.at_rung(0).polygons, 1000);
  EXPECT_EQ(cubes.at_rung(0).error_px, 0);
  // 50 · 0.1 · √3 / (9.5 - 0.1) = 0.921 px: within 1, not within 0.5.
  EXPECT_EQ(cubes.at_rung(2).parts, Parts({0}));
  EXPECT_EQ(cubes.at_rung(3).parts, Parts({10}));
  EXPECT_EQ(cubes.at_rung(3).polygons, 500);
  EXPECT_NEAR(cubes.at_rung(3).error_px, 0.9213, 1e-4);
  // 50 · 0.5 · √3 / 9 = 4.811 px: within 8, not within 4.
  EXPECT_EQ(cubes.at_rung(5).parts, Parts({10}));
  EXPECT_EQ(cubes.at_rung(6).parts, Parts({20}));
  EXPECT_NEAR(cubes.at_rung(6).error_px, 4.8113, 1e-4);
}

// The diagonal covers 50 · √3 · √3 / (9.5 - √3) = 19.31 px, and 100 triangles are left out at √(100/192) of what is allowed.
TEST(MemberLevelsByHand, APartIsLeftOutWhereAllOfItIsNoLargerThanTheErrorAndOneIsAlwaysDrawn) {
  Cubes cubes;
  EXPECT_EQ(cubes.at_rung(8).parts, Parts({20})) << "17.3 of 24 px";
  const MemberLevels none = cubes.at_rung(9);
  EXPECT_EQ(none.parts, Parts({20})) << "23.1 of 32 px, and a picture of nothing is still one of the layer";
  EXPECT_NEAR(none.error_px, 19.310, 1e-3);
  // The cube at the right comes before the eye, too: what is left out is the smaller one.
  cubes.now.world_from_part[1] = glm::translate(dmat4(1), dvec3(0, 0, -3));
  EXPECT_EQ(cubes.at_rung(9).parts, Parts({21}));
  EXPECT_EQ(cubes.at_rung(9).polygons, 100);
}

TEST(MemberLevelsByHand, OneLevelForAllLeavesOutWhatIsOutsideAlone) {
  const Cubes cubes;
  const MemberLevels coarse =
      layers::ShownMembers(cubes.scene, cubes.layer, cubes.now, cubes.placement).at_level(2);
  EXPECT_EQ(coarse.parts, Parts({20}));
  EXPECT_EQ(coarse.polygons, 100);
  const MemberLevels beyond =
      layers::ShownMembers(cubes.scene, cubes.layer, cubes.now, cubes.placement).at_level(9);
  EXPECT_EQ(beyond.parts, Parts({20})) << "no ladder has ten levels";
}

// What stands across a side of the sprite, or around the eye, is not outside.
TEST(MemberLevelsByHand, WhatCrossesASideOrTheEyeIsDrawn) {
  Cubes cubes;
  cubes.now.world_from_part[1] = glm::translate(dmat4(1), dvec3(10.3, 0, -10));
  cubes.now.world_from_part[2] = dmat4(1);
  EXPECT_EQ(cubes.at_rung(0).parts, Parts({0, 1, 2}));
  EXPECT_EQ(cubes.at_rung(0).polygons, 3000);
  cubes.placement.screen_from_sprite.tx = 60;  // a sprite of the right of the display, from 60 px on
  cubes.placement.size_px = {40, 100};
  EXPECT_EQ(cubes.at_rung(0).parts, Parts({1, 2})) << "the first ends at 52.6 px, the rim begins at 58";
}

}  // namespace
}  // namespace talisman::tests
