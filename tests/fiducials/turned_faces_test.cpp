// SPDX-License-Identifier: Apache-2.0
#include "fiducials/turned_faces.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/layers/worlds.h"

namespace talisman::fiducials {
namespace {

using layers::dmat4;
using layers::LayerState;
using tests::moved_by;
using tests::turned_by;

constexpr double kHalfTurn_rad = std::numbers::pi;
const dmat4 kFacing = moved_by({0, 0, -10});

struct Box : tests::World {
  explicit Box(const dvec3& half_size = {1, 1, 1}, layers::BoundKind kind = layers::BoundKind::Box8)
      : World(tests::box_corners(half_size), kind) {
    bound.follows_faces = true;
  }
  TurnedFaces compare(const LayerState& then, const LayerState& now) const {
    return turned_faces_of(then, now, bound.hull);
  }
};

// Turned by a few degrees about the vertical, a box shows one more side; by more, a larger part of it.
TEST(TurnedFacesOf, OneSideOfATurningBoxComesIntoViewSteadily) {
  const Box box;
  const LayerState then = box.at(kFacing);
  double before = 0;
  for (const double angle : {0.15, 0.3, 0.6, 0.9}) {
    const TurnedFaces t = box.compare(then, box.at(kFacing * turned_by(angle, {0, 1, 0})));
    EXPECT_TRUE(t.computed);
    EXPECT_EQ(t.count, 1) << angle;
    EXPECT_GT(t.px, before);
    before = t.px;
  }
}

TEST(TurnedFacesOf, SizeIsThatOfTheSideOnTheDisplay) {
  const Box box;
  const TurnedFaces t =
      box.compare(box.at(kFacing), box.at(kFacing * turned_by(kHalfTurn_rad / 2, {0, 1, 0})));
  // A quarter turn: what was a side (4 corners at 9 m) is the front now.
  const double focal = 512 / std::tan(layers::CameraState{}.fov_y_rad / 2);
  EXPECT_EQ(t.count, 1);
  EXPECT_NEAR(t.px, 2 * focal / 9, 1e-6);
  EXPECT_NEAR(t.where_px.x, 512, 1e-6);
  EXPECT_NEAR(t.where_px.y, 512, 1e-6);
}

// Sides that turn away are not missed in the old sprite; they are too many, which the geometric fiducial
// sees.
TEST(TurnedFacesOf, TurningBackShowsNothingNew) {
  const Box box;
  const LayerState turned = box.at(kFacing * turned_by(0.5, {0, 1, 0}));
  EXPECT_EQ(box.compare(turned, box.at(kFacing)).count, 0);
}

TEST(TurnedFacesOf, TheEyeThatMovesAroundCountsAsTheLayerThatTurns) {
  const Box box;
  const dmat4 around = kFacing * turned_by(-0.4, {0, 1, 0}) * inverse(kFacing);
  const TurnedFaces by_eye = box.compare(box.at(kFacing), box.at(kFacing, tests::camera_at(around)));
  const TurnedFaces by_layer = box.compare(box.at(kFacing), box.at(kFacing * turned_by(0.4, {0, 1, 0})));
  EXPECT_EQ(by_eye.count, 1);
  EXPECT_NEAR(by_eye.px, by_layer.px, 1e-9);
}

// A plate has two sides and four edges without area. Turned about and seen edge-on, only the sides may count,
// whatever the rounding makes of the edges.
TEST(TurnedFacesOf, FlatLayersDoNotFlicker) {
  const Box plate({1, 1, 0});
  const LayerState front = plate.at(kFacing),
                   edge = plate.at(kFacing * turned_by(kHalfTurn_rad / 2, {0, 1, 0}));
  for (int i = -50; i <= 50; ++i) {
    const double angle = i * 0.03;  // never quite a quarter turn
    EXPECT_EQ(plate.compare(front, plate.at(kFacing * turned_by(angle, {0, 1, 0}))).count, 0) << angle;
  }
  for (const double noise : {-1e-12, 1e-12}) {
    const LayerState near_edge = plate.at(kFacing * turned_by(kHalfTurn_rad / 2 + noise, {0, 1, 0}));
    EXPECT_LT(plate.compare(front, near_edge).px, 1e-3);
    EXPECT_LT(plate.compare(edge, near_edge).px, 1e-3);
  }
  const TurnedFaces about = plate.compare(front, plate.at(kFacing * turned_by(kHalfTurn_rad, {0, 1, 0})));
  EXPECT_EQ(about.count, 1);
  EXPECT_GT(about.px, 100);
}

TEST(TurnedFacesOf, PointsAndLinesHaveNoSides) {
  for (const dvec3& half_size : {dvec3(0, 0, 0), dvec3(1, 0, 0)}) {
    const Box box(half_size);
    const TurnedFaces t = box.compare(box.at(kFacing), box.at(kFacing * turned_by(2, {1, 2, 3})));
    EXPECT_TRUE(t.computed);
    EXPECT_EQ(t.count, 0);
    EXPECT_EQ(t.px, 0);
  }
}

// A mirrored layer's triangles are clockwise; its faces face the eye all the same.
TEST(TurnedFacesOf, MirroredLayersAreJudgedLikeOthers) {
  const Box box;
  const dmat4 mirror = glm::scale(dmat4(1.0), dvec3(-1, 1, 1));
  const auto turned = [&](const dmat4& m) {
    return box.compare(box.at(kFacing * m), box.at(kFacing * turned_by(0.4, {0, 1, 0}) * m));
  };
  EXPECT_EQ(turned(mirror).count, 1);
  EXPECT_NEAR(turned(mirror).px, turned(dmat4(1.0)).px, 1e-9);
}

// A side that reaches behind the eye has no area on the display before it is cut at the near plane.
TEST(TurnedFacesOf, SidesThroughTheNearPlaneAreFinite) {
  const Box wall({0.5, 1, 30});
  const LayerState then = wall.at(moved_by({0.2, 0, -1})), now = wall.at(moved_by({2, 0, -1}));
  const TurnedFaces t = wall.compare(then, now);
  EXPECT_EQ(t.count, 1);
  EXPECT_GT(t.px, 100);
  EXPECT_LE(t.px, 1024);
}

TEST(TurnedFacesOf, OutsideTheDisplayNothingIsShown) {
  const Box box;
  const TurnedFaces t =
      box.compare(box.at(moved_by({50, 0, -10})), box.at(moved_by({50, 0, -10}) * turned_by(1.5, {0, 1, 0})));
  EXPECT_GT(t.count, 0);
  EXPECT_EQ(t.px, 0);
}

TEST(TurnedFacesOf, IsNotComputedWhereItWasNotAskedFor) {
  Box box;
  box.bound.follows_faces = false;
  const LayerState state = box.at(kFacing);
  EXPECT_TRUE(state.world_from_body.empty());
  const TurnedFaces t = box.compare(state, state);
  EXPECT_FALSE(t.computed);
  EXPECT_EQ(t.why_not, "not asked for");
}

}  // namespace
}  // namespace talisman::fiducials
