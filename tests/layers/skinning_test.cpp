// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "layers/scene.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

TEST(WorldPositions, RigidPartFollowsItsNode) {
  Scene scene = tests::cube_scene();
  scene.nodes[0].local.translation = {1, 2, 3};
  scene.nodes[0].local.scale = {2, 1, 1};
  const auto world = world_positions(scene.at(0), scene.parts[0]);
  const auto& local = scene.meshes[0].positions;
  ASSERT_EQ(world.size(), local.size());
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_EQ(world[i], dvec3(1 + 2.0 * local[i].x, 2.0 + local[i].y, 3.0 + local[i].z));
}

TEST(WorldPositions, BindPoseIsTheMeshItself) {
  const Scene scene = tests::skinned_bar_scene();
  const auto world = world_positions(scene.at(0), scene.parts[0]);
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_LT(glm::distance(world[i], dvec3(scene.meshes[0].positions[i])), 1e-12);
}

// Bent by 60° about (0, 1, 0): the lower quarter stays, the tip of the axis goes to (-sin 60°, 1 + cos 60°).
TEST(WorldPositions, BentBarMovesItsUpperHalfOnly) {
  const Scene scene = tests::skinned_bar_scene();
  const auto world = world_positions(scene.at(1), scene.parts[0]);
  const auto& rest = scene.meshes[0].positions;
  dvec3 tip{0, 0, 0};
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (rest[i].y <= 0.5f) {
      EXPECT_LT(glm::distance(world[i], dvec3(rest[i])), 1e-12);
    }
    if (rest[i].y == 2) tip += world[i] / 4.0;
  }
  EXPECT_LT(glm::distance(tip, dvec3{-std::sqrt(3.0) / 2, 1.5, 0}), 1e-6);
}

// As in glTF, the node of a skinned mesh does not count: only its joints move it.
TEST(WorldPositions, SkinnedPartIgnoresItsOwnNode) {
  Scene scene = tests::skinned_bar_scene();
  const auto before = world_positions(scene.at(0.7), scene.parts[0]);
  scene.nodes[scene.parts[0].node].local.translation = {100, 0, 0};
  EXPECT_EQ(world_positions(scene.at(0.7), scene.parts[0]), before);
}

// Exported weights rarely sum to exactly 1; taken as they are, they would pull vertices to the world's
// origin.
TEST(WorldPositions, WeightsAreDividedByTheirSum) {
  Scene scene = tests::skinned_bar_scene();
  const auto before = world_positions(scene.at(1), scene.parts[0]);
  for (vec4& weights : scene.meshes[0].weights) weights *= 0.5f;
  const auto after = world_positions(scene.at(1), scene.parts[0]);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT(glm::distance(before[i], after[i]), 1e-12);
}

TEST(WorldPositions, VertexWithoutWeightsFollowsItsFirstJoint) {
  Scene scene = tests::skinned_bar_scene();
  for (vec4& weights : scene.meshes[0].weights) weights = {0, 0, 0, 0};
  const auto world = world_positions(scene.at(1), scene.parts[0]);
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_EQ(world[i], dvec3(scene.meshes[0].positions[i])) << "joint 0 stands still";
}

TEST(WorldPositions, EmptyMeshHasNone) {
  Scene scene = tests::cube_scene();
  scene.meshes[0] = Mesh{};
  EXPECT_TRUE(world_positions(scene.at(0), scene.parts[0]).empty());
}

TEST(JointPalette, IsEmptyForRigidParts) {
  const Scene scene = tests::cube_scene();
  EXPECT_TRUE(joint_palette(scene.at(0), scene.parts[0]).empty());
}

TEST(JointPalette, IsTheIdentityInTheBindPose) {
  const Scene scene = tests::skinned_bar_scene();
  const auto palette = joint_palette(scene.at(0), scene.parts[0]);
  ASSERT_EQ(palette.size(), 2u);
  for (const dmat4& matrix : palette) EXPECT_EQ(matrix, dmat4(1));
}

}  // namespace
}  // namespace talisman::layers
