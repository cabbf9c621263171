// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "layers/polyhedron.h"
#include "layers/state.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using tests::box_corners;
using tests::moved_by;

const std::vector<dmat4> kOneBody = {dmat4(1.0)};
constexpr BoundKind kBoundKinds[] = {BoundKind::Box8, BoundKind::Dop14, BoundKind::Dop26};

/// Points on a sphere: every face of every kind has an area.
std::vector<dvec3> sphere() {
  std::mt19937 random(2);
  std::vector<dvec3> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back(glm::normalize(tests::uniform3(random, -1, 1) + dvec3(1e-3)));
  return points;
}

TEST(FaceEnds, CountThePlanesOfEachKindAndCloseTheSurface) {
  const std::size_t planes[] = {6, 14, 26};
  for (const BoundKind kind : kBoundKinds) {
    EXPECT_EQ(face_ends(kind).size(), planes[static_cast<int>(kind)]);
    EXPECT_EQ(face_ends(kind).back(), static_cast<int>(topology(kind).size()));
    dvec3 sum(0.0);  // the areas of a closed surface add up to nothing
    const Polyhedron hull = bounding_polyhedron(sphere(), kind);
    for (const dvec3& area : face_areas(hull.points, hull, kOneBody)) sum += area;
    EXPECT_LT(glm::length(sum), 1e-12);
  }
}

TEST(FaceAreas, AreTwiceTheAreaOutwards) {
  const Polyhedron box = bounding_polyhedron(box_corners({1, 2, 3}), BoundKind::Box8);
  std::vector<double> lengths;
  for (const dvec3& area : face_areas(box.points, box, kOneBody)) {
    EXPECT_NEAR(std::max({std::fabs(area.x), std::fabs(area.y), std::fabs(area.z)}), glm::length(area),
                1e-12);
    lengths.push_back(glm::length(area));
  }
  std::sort(lengths.begin(), lengths.end());
  EXPECT_EQ(lengths, (std::vector<double>{16, 16, 24, 24, 48, 48}));
}

TEST(PointNormals, OfACubePointIntoTheEightOctants) {
  const Polyhedron cube = bounding_polyhedron(box_corners({1, 1, 1}), BoundKind::Box8);
  const auto normals = point_normals(cube.points, cube, kOneBody);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_LT(glm::distance(normals[i], cube.points[i] / std::sqrt(3.0)), 1e-14);
}

TEST(PointNormals, OfEveryKindAreOfUnitLengthAndPointOutwards) {
  for (const BoundKind kind : kBoundKinds) {
    const Polyhedron hull = bounding_polyhedron(sphere(), kind);
    const auto normals = point_normals(hull.points, hull, kOneBody);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      EXPECT_NEAR(glm::length(normals[i]), 1, 1e-14);
      EXPECT_GT(dot(normals[i], hull.points[i]), 0.9 * glm::length(hull.points[i]));
    }
  }
}

// The richer kinds have points between faces without area, at the plate's rim: they sample no side, and must
// not make up a third one.
TEST(PointNormals, OfAFlatLayerAreThoseOfItsTwoSides) {
  for (const BoundKind kind : kBoundKinds) {
    const Polyhedron plate = bounding_polyhedron(box_corners({2, 3, 0}), kind);
    int front = 0, back = 0;
    for (const dvec3& n : point_normals(plate.points, plate, kOneBody)) {
      EXPECT_TRUE(n == dvec3(0.0) || std::fabs(n.z) == 1);
      front += n.z > 0;
      back += n.z < 0;
    }
    EXPECT_EQ(front, back);
    EXPECT_GE(front, 4);
  }
}

// No area at all: outwards from the middle, and nowhere for a single point.
TEST(PointNormals, OfLinesAndPointsAreFinite) {
  const Polyhedron line = bounding_polyhedron(box_corners({2, 0, 0}), BoundKind::Box8);
  for (const dvec3& n : point_normals(line.points, line, kOneBody)) EXPECT_EQ(std::fabs(n.x), 1);
  const Polyhedron point = bounding_polyhedron(box_corners({0, 0, 0}), BoundKind::Box8);
  for (const dvec3& n : point_normals(point.points, point, kOneBody)) EXPECT_EQ(n, dvec3(0.0));
}

TEST(PointNormals, DoNotDependOnTheUnitOfLength) {
  for (const double unit : {1e-100, 1e-4, 1e6, 1e100}) {
    const Polyhedron cube = bounding_polyhedron(box_corners(dvec3(unit)), BoundKind::Box8);
    for (const dvec3& n : point_normals(cube.points, cube, kOneBody))
      EXPECT_NEAR(std::fabs(n.x), 1 / std::sqrt(3.0), 1e-14) << unit;
  }
}

// One body turned right-handed, the other a mirror image: both have their normals outside.
TEST(PointNormals, EachBodyHasItsOwnHand) {
  Scene scene = tests::cube_scene();
  scene.nodes.emplace_back();
  scene.nodes.back().local.translation = {5, 0, 0};
  scene.nodes.back().local.scale = {-1, 1, 1};
  scene.parts.push_back(scene.parts[0]);
  scene.parts.back().node = static_cast<int>(scene.nodes.size()) - 1;
  scene.tracks.push_back({scene.parts.back().node, SpinTrack{{0, 1, 0}, 1}});
  Layer layer;
  layer.parts = {0, 1};
  layer.preferences.bound_each_part = true;
  LayerBound bound = make_layer_bound(scene, layer, BoundKind::Box8);
  bound.surface.emplace();
  const LayerState state = capture(scene.at(0), layer, bound, View{});
  ASSERT_EQ(state.world_from_body.size(), 2u);
  ASSERT_EQ(state.world_normals.size(), 16u);
  for (int i = 0; i < 16; ++i) {
    const dvec3 middle(i < 8 ? 0 : 5, 0, 0);
    EXPECT_GT(dot(state.world_normals[i], state.world_points[i] - middle), 0.5) << i;
  }
}

TEST(Capture, ShadesThePointsOnlyWhereTheBoundHasASurface) {
  tests::World world(box_corners({1, 1, 1}));
  const LayerState plain = world.at(moved_by({0, 0, -5}));
  EXPECT_TRUE(plain.world_normals.empty() && plain.point_colors.empty() && plain.world_from_body.empty());
  world.bound.surface.emplace();
  world.bound.surface->base = {1, 1, 1};
  const LayerState shaded = world.at(moved_by({0, 0, -5}));
  EXPECT_EQ(shaded.world_normals.size(), 8u);
  EXPECT_EQ(shaded.point_colors.size(), 8u);
  EXPECT_EQ(shaded.world_from_body, std::vector<dmat4>{moved_by({0, 0, -5})});
  EXPECT_TRUE(plain.same_pixels(shaded)) << "what is known of the light does not change the pixels";
}

}  // namespace
}  // namespace talisman::layers
