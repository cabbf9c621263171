// SPDX-License-Identifier: Apache-2.0
#include "layers/part_box.h"

#include <gtest/gtest.h>

#include "tests/support/fleet.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Every vertex at many times lies in the box, which is no larger than the vertices' own by `slack` of its size.
void expect_boxes_hold_their_parts(const Scene& scene, double slack) {
  const std::vector<MeshBox> meshes = mesh_boxes(scene);
  for (const double t : {0.0, 0.37, 1.0, 5.1, -2.0}) {
    const SceneFrame frame = scene.at(t);
    for (const Part& part : scene.parts) {
      const Box3 box = part_box(frame, part, meshes[part.mesh]), tight = box_of(world_positions(frame, part));
      EXPECT_EQ(joined(box, tight), box) << part.name << " at " << t;
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(box.hi[k] - box.lo[k],
                  (1 + slack) * (tight.hi[k] - tight.lo[k]) + 1e-5 * std::fabs(tight.hi[k]))
            << part.name;
    }
  }
}

TEST(PartBox, HoldsRigidParts) {
  for (const Scene& scene :
       {tests::cube_scene(), tests::moving_scene(), tests::tiny_scene(), tests::huge_scene()})
    expect_boxes_hold_their_parts(scene, 1);  // a turned cube's box is at most √3 as wide
  expect_boxes_hold_their_parts(tests::fleet_scene(10, 3), 1);
}

TEST(PartBox, HoldsSkinnedParts) { expect_boxes_hold_their_parts(tests::skinned_bar_scene(), 3); }

// Weights below 0 and above 1 are weights, too: the target reaches the other way, and farther.
TEST(PartBox, HoldsMorphedPartsAtAnyWeights) {
  Scene scene = tests::cube_scene();
  Mesh& mesh = scene.meshes.front();
  MorphTarget target;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    target.positions.push_back({i % 3 == 0 ? 1.f : 0.f, i % 5 == 0 ? -2.f : 0.f, 0.5f});
  mesh.morphs = {target, MorphTarget{}};
  for (const double weight : {-3.0, 0.0, 0.5, 7.0}) {
    for (Node& node : scene.nodes) node.morph_weights = {weight, 1};
    expect_boxes_hold_their_parts(scene, 8);
  }
}

TEST(PartBox, WithoutVerticesIsEmptyAndWithAnInfiniteOneEverywhere) {
  Scene scene = tests::cube_scene();
  const SceneFrame frame = scene.at(0);
  Mesh none;
  EXPECT_TRUE(part_box(frame, scene.parts[0], mesh_box(none)).empty());
  Mesh broken = scene.meshes[0];
  broken.positions[3].y = kNone;
  EXPECT_EQ(part_box(frame, scene.parts[0], mesh_box(broken)), kEverywhere);
}

}  // namespace
}  // namespace talisman::layers
