// SPDX-License-Identifier: Apache-2.0
#include "layers/advance.h"

#include <array>
#include <bit>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/fleet.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

/// To the bit: 0 is not -0, and a NaN is itself.
template <typename T>
bool same_bits(const T& a, const T& b) {
  using Bytes = std::array<unsigned char, sizeof(T)>;
  return std::bit_cast<Bytes>(a) == std::bit_cast<Bytes>(b);
}

bool same_bits(const LightState& a, const LightState& b) {
  return a == b && same_bits(a.position, b.position) && same_bits(a.direction, b.direction);
}

void expect_same(const SceneFrame& a, const SceneFrame& b) {
  ASSERT_EQ(a.world_from_node.size(), b.world_from_node.size());
  EXPECT_EQ(a.scene, b.scene);
  EXPECT_EQ(a.time_s, b.time_s);
  for (std::size_t i = 0; i < a.world_from_node.size(); ++i)
    ASSERT_TRUE(same_bits(a.world_from_node[i], b.world_from_node[i])) << "node " << i << " at " << a.time_s;
  EXPECT_TRUE(same_bits(a.camera.world_from_camera, b.camera.world_from_camera));
  EXPECT_EQ(a.camera, b.camera);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) EXPECT_TRUE(same_bits(a.lights[i], b.lights[i]));
  EXPECT_EQ(a.morph_weights, b.morph_weights);
  EXPECT_EQ(a.picture_frames, b.picture_frames);
}

Track track_of(int node, TransformTrack motion) { return {node, std::move(motion)}; }

/// Every kind of motion, several tracks on one node, children of what moves, tracks whose keys are all equal but for
/// the sign of zero, a node whose product overflows, lights and a camera that are carried, morphs.
Scene everything_scene() {
  Scene scene = tests::moving_scene();
  const int old_nodes = static_cast<int>(scene.nodes.size());
  const auto add_node = [&](int parent, Transform local = {}) {
    scene.nodes.push_back({"n" + std::to_string(scene.nodes.size()), parent, local});
    return static_cast<int>(scene.nodes.size()) - 1;
  };
  const int rest = add_node(-1, {{1, 2, 3}, {0.6, 0, 0.8, 0}, {2, -1, 1}}), below_rest = add_node(rest);
  const int spun = add_node(below_rest), below = add_node(add_node(spun));
  scene.tracks.push_back({spun, SpinTrack{{1, 2, 3}, 0.7}});
  scene.tracks.push_back(track_of(spun, {{{0, 1, 3}, {{0, 0, 0}, {1, 0, 0}, {1, 5, 0}}}, {}, {}, true}));
  scene.tracks.push_back(track_of(below, {{}, {}, {{0, 2}, {{1, 1, 1}, {3, 1, 0.5}}}, true, 2.5}));
  const int signs = add_node(-1);
  scene.tracks.push_back(track_of(signs, {{{0, 1}, {{0, 0, 0}, {-0.0, 0, 0}}, Interpolation::Step}, {}, {}}));
  const int one_key = add_node(-1);
  scene.tracks.push_back(track_of(one_key, {{{1}, {{7, 0, 0}}}, {}, {}}));
  const int huge = add_node(spun, {{0, 0, 0}, {1, 0, 0, 0}, {1e200, 1e200, 1e200}});
  add_node(huge, {{1, 1, 1}, {1, 0, 0, 0}, {1e200, 1e200, 1e200}});
  for (const int node : {-1, rest, below, old_nodes - 1}) {
    Light light;
    light.kind = Light::Kind::Spot;
    light.node = node;
    scene.lights.push_back(light);
  }
  scene.meshes[0].morphs.push_back({});
  scene.nodes[0].morph_weights = {0.25};
  MorphTrack morph;
  morph.weights.push_back({{0, 1}, {0, 1}});
  scene.tracks.push_back({spun, morph});
  return scene;
}

void expect_same_at_random_times(const Scene& scene, int jumps) {
  const SceneMotion motion(scene);
  SceneFrame frame;
  std::mt19937 lot(1997);
  std::uniform_real_distribution<double> near(-1, 6);
  for (int k = 0; k < jumps && !testing::Test::HasFailure(); ++k) {
    const double t = k % 50 == 0 ? near(lot) * 1e7 : k % 7 == 0 ? std::round(near(lot)) : near(lot);
    motion.advance(frame, t);
    expect_same(frame, scene.at(t));
  }
}

TEST(SceneMotion, AdvanceEqualsAtToTheBitOnTenThousandJumps) {
  const Scene scene = everything_scene();
  ASSERT_EQ(first_defect(scene), "");
  expect_same_at_random_times(scene, 10'000);
}

TEST(SceneMotion, AdvanceEqualsAtOnOtherScenes) {
  for (const Scene& scene : {tests::skinned_bar_scene(), tests::fleet_scene(20, 4), tests::cube_scene(),
                             tests::tiny_scene(), tests::huge_scene(), Scene{}})
    expect_same_at_random_times(scene, 200);
}

TEST(SceneMotion, TouchesWhatMovesAlone) {
  const Scene scene = everything_scene();
  const SceneMotion motion(scene);
  for (int node = 0; node < static_cast<int>(scene.nodes.size()); ++node) {
    if (motion.moves(node)) continue;
    for (const double t : {-3.0, 0.0, 0.3, 1.0, 2.7, 1e6})
      EXPECT_TRUE(same_bits(scene.at(t).world_from_node[node], scene.at(0).world_from_node[node])) << node;
  }
  EXPECT_FALSE(motion.moves(-1));
  // The single key stands still; the sign of a zero does not.
  const int signs = static_cast<int>(scene.nodes.size()) - 4, one_key = signs + 1;
  EXPECT_TRUE(motion.moves(signs));
  EXPECT_FALSE(motion.moves(one_key));
  EXPECT_TRUE(SceneMotion(tests::cube_scene()).moving_nodes().empty());
}

// A frame of another scene of the same size is not taken for one of this.
TEST(SceneMotion, AFrameOfAnotherSceneIsMadeAnew) {
  const Scene one = tests::fleet_scene(5, 1), other = tests::fleet_scene(5, 2);
  SceneFrame frame = other.at(0.5);
  SceneMotion(one).advance(frame, 0.25);
  expect_same(frame, one.at(0.25));
}

}  // namespace
}  // namespace talisman::layers
