// SPDX-License-Identifier: Apache-2.0
// Parts that move as one, and the few points that carry their motion.
#include "layers/rigid_groups.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "layers/prediction_primitive.h"

namespace talisman::layers {
namespace {

/// A scene of parts without meshes to speak of, one for each node that is named.
struct Rig {
  Scene scene;
  int add(int parent, const dvec3& place, std::optional<SpinTrack> spin = {}) {
    scene.nodes.push_back({"n", parent, {place, {1, 0, 0, 0}, dvec3(1)}});
    const int node = static_cast<int>(scene.nodes.size()) - 1;
    if (spin) scene.tracks.push_back({node, *spin});
    if (scene.meshes.empty()) scene.meshes.emplace_back();
    if (scene.materials.empty()) scene.materials.emplace_back();
    scene.parts.push_back({"p", node, 0, 0, -1});
    return node;
  }
  std::vector<std::vector<int>> groups(int frames = 5) {
    std::vector<int> parts;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) parts.push_back(static_cast<int>(i));
    RigidGroups found(scene.at(0), parts);
    for (int f = 1; f < frames; ++f) found.follow(scene.at(0.1 * f));
    return found.groups();
  }
};

using Groups = std::vector<std::vector<int>>;

TEST(RigidGroups, WhatHangsOnOneNodeOrStandsStillIsOne) {
  Rig rig;
  const int wheel = rig.add(-1, {0, 0, 0}, SpinTrack{{0, 1, 0}, 1});
  rig.add(wheel, {1, 0, 0});
  rig.add(-1, {5, 0, 0});
  rig.add(wheel, {-1, 2, 0});
  rig.add(-1, {-5, 3, 0});
  EXPECT_EQ(rig.groups(), (Groups{{0, 1, 3}, {2, 4}}));
}

TEST(RigidGroups, NodesThatTurnAlikeAboutOneAxisAreOneWhateverTheTreeSays) {
  // Two trees, both turned about the world's y axis at one rate.
  Rig rig;
  rig.add(-1, {0, 1, 0}, SpinTrack{{0, 1, 0}, 1});
  rig.add(-1, {0, 7, 0}, SpinTrack{{0, 1, 0}, 1});
  rig.add(-1, {1, 0, 0}, SpinTrack{{0, 1, 0}, 1});  // about an axis of its own
  rig.add(-1, {0, 3, 0}, SpinTrack{{0, 1, 0}, 1.001});
  EXPECT_EQ(rig.groups(), (Groups{{0, 1}, {2}, {3}}));
}

TEST(RigidGroups, ApartForAMomentIsApart) {
  // Both are where they began in every second frame that is looked at.
  Rig rig;
  rig.add(-1, {0, 0, 0}, SpinTrack{{0, 1, 0}, 2 * M_PI / 0.2});
  rig.add(-1, {1, 0, 0});
  EXPECT_EQ(rig.groups(), (Groups{{0}, {1}}));
}

TEST(RigidGroups, WhatHasNoVolumeOrDeformsIsAlone) {
  Rig rig;
  rig.add(-1, {0, 0, 0});
  rig.add(-1, {1, 0, 0});
  rig.scene.nodes[1].local.scale = dvec3(0);
  rig.add(-1, {2, 0, 0});
  rig.scene.skins.push_back({"s", {0}, {dmat4(1.0)}});
  rig.scene.parts[2].skin = 0;
  rig.add(-1, {3, 0, 0});
  EXPECT_EQ(rig.groups(), (Groups{{0, 3}, {1}, {2}}));
}

Mesh mesh_of(const std::vector<vec3>& points) {
  Mesh mesh;
  mesh.positions = points;
  for (std::uint32_t i = 0; i + 2 < points.size(); ++i)
    mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 2});
  return mesh;
}

TEST(PredictionPrimitive, FewVerticesAreThemselves) {
  const PredictionPrimitive quad =
      prediction_primitive(mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}));
  EXPECT_EQ(quad.kind, PrimitiveKind::Polygon);
  EXPECT_EQ(quad.points.size(), 4u);  // the one that is there twice counts once
  EXPECT_TRUE(prediction_primitive(Mesh{}).points.empty());
}

TEST(PredictionPrimitive, ABoxIsABlock) {
  std::vector<vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i & 2, i & 4);
  const PredictionPrimitive block = prediction_primitive(mesh_of(corners));
  EXPECT_EQ(block.kind, PrimitiveKind::Block);
  ASSERT_EQ(block.points.size(), 8u);
  for (const vec3& corner : corners)
    EXPECT_NE(std::find(block.points.begin(), block.points.end(), dvec3(corner)), block.points.end());
}

TEST(PredictionPrimitive, ASphereIsAnOctahedronOfRoot3RadiiThatEnclosesIt) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  std::vector<vec3> points;
  for (int i = 0; i < 5000; ++i)
    points.push_back(2.0f * glm::normalize(vec3(normal(random), normal(random), normal(random))));
  for (int axis = 0; axis < 3; ++axis)  // so that its bounds are those of the sphere
    for (const float side : {-2.0f, 2.0f}) {
      vec3 pole(0);
      pole[axis] = side;
      points.push_back(pole);
    }
  const PredictionPrimitive octahedron = prediction_primitive(mesh_of(points));
  EXPECT_EQ(octahedron.kind, PrimitiveKind::Octahedron);
  ASSERT_EQ(octahedron.points.size(), 6u);
  EXPECT_NEAR(octahedron.points[1].x, 2 * std::sqrt(3.0), 0.01);
  const double reach = octahedron.points[1].x;
  for (const vec3& p : points) ASSERT_LE(std::abs(p.x) + std::abs(p.y) + std::abs(p.z), reach * (1 + 1e-6));
}

}  // namespace
}  // namespace talisman::layers
