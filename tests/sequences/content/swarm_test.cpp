// SPDX-License-Identifier: Apache-2.0
// Swarms of sequence files: what is asked for is there, the same everywhere, and what is wrong is refused.
#include "sequences/content/swarm/swarm.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/files/errors.h"
#include "tests/sequences/sequence_lines.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;

layers::Scene scene_of(const SwarmContent& swarm, double fps = 30, double last_s = 3.3) {
  layers::Scene scene;
  add_swarm(scene, swarm, fps, last_s);
  return scene;
}

dvec3 place(const layers::SceneFrame& frame, int part) {
  return dvec3(frame.world_from_node[frame.scene->parts[part].node][3]);
}

TEST(Swarm, TheShareThatMovesIsExactAndTheRestStands) {
  for (const double percent : {0.0, 1.0, 25.0, 75.0, 100.0}) {
    SwarmContent swarm;
    swarm.count = 200;
    swarm.moving_percent = percent;
    const layers::Scene scene = scene_of(swarm);
    const layers::SceneFrame first = scene.at(0), later = scene.at(1);
    int moved = 0;
    for (int i = 0; i < swarm.count; ++i)
      moved += first.world_from_node[scene.parts[i].node] != later.world_from_node[scene.parts[i].node];
    EXPECT_EQ(moved, std::lround(2 * percent));
    EXPECT_EQ(moved, moving_count(swarm));
  }
}

TEST(Swarm, WrapsAroundAndKeepsItsSteps) {
  // Fast things in a small cube: each leaves it often. Between two frames they move by their velocity, or by that and
  // a side of the cube.
  SwarmContent swarm;
  swarm.count = 50;
  swarm.cube_m = 2;
  swarm.translation_m = 0.4;
  const layers::Scene scene = scene_of(swarm);
  ASSERT_EQ(layers::first_defect(scene), "");
  int jumps = 0;
  for (int frame = 0; frame < 99; ++frame) {
    const layers::SceneFrame now = scene.at(frame / 30.0), next = scene.at((frame + 1) / 30.0);
    for (int i = 0; i < swarm.count; ++i) {
      const dvec3 step = place(next, i) - place(now, i);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_LE(std::abs(place(next, i)[axis]), 1 + 1e-9);
        const double rest = std::remainder(step[axis], 2.0);
        ASSERT_LE(std::abs(rest), 0.4 + 1e-9);
        jumps += std::abs(step[axis]) > 1;
      }
    }
  }
  EXPECT_GT(jumps, 100);
}

TEST(Swarm, WithoutWrappingItFliesOn) {
  SwarmContent swarm;
  swarm.count = 20;
  swarm.cube_m = 2;
  swarm.wrap = false;
  const layers::Scene scene = scene_of(swarm);
  double farthest = 0;
  for (int i = 0; i < swarm.count; ++i) farthest = std::max(farthest, glm::length(place(scene.at(3.3), i)));
  EXPECT_GT(farthest, 4);
}

TEST(Swarm, QuadsAreThoseOfTheThesis) {
  // Triangles: two a quad, and one where a quad ends in a pole: 2 · 16 of each sphere.
  const std::pair<SwarmContent::Shape, int> shapes[] = {{SwarmContent::Shape::Quad, 2},
                                                        {SwarmContent::Shape::Block, 12},
                                                        {SwarmContent::Shape::Sphere, 2 * 144 - 32},
                                                        {SwarmContent::Shape::Molecule, 2 * 300 - 64}};
  for (const auto& [shape, triangles] : shapes) {
    SwarmContent swarm;
    swarm.shape = shape;
    swarm.count = 1;
    const layers::Scene scene = scene_of(swarm);
    EXPECT_EQ(scene.meshes.front().triangle_count(), triangles) << quads_of(shape);
    // Normals point the way the triangles face.
    const layers::Mesh& mesh = scene.meshes.front();
    double inside = 0;
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
      const auto at = [&](int c) { return dvec3(mesh.positions[mesh.indices[k + c]]); };
      const dvec3 facing = glm::cross(at(1) - at(0), at(2) - at(0));
      inside += glm::dot(facing, dvec3(mesh.normals[mesh.indices[k]])) <= 0;
    }
    EXPECT_EQ(inside, 0) << quads_of(shape);
  }
}

TEST(Swarm, MoleculesLieWithinTheirRadius) {
  SwarmContent swarm;
  swarm.shape = SwarmContent::Shape::Molecule;
  swarm.count = 1;
  double farthest = 0;
  const layers::Scene scene = scene_of(swarm);
  for (const auto& p : scene.meshes.front().positions)
    farthest = std::max(farthest, static_cast<double>(glm::length(p)));
  EXPECT_LE(farthest, 2.5);
  EXPECT_GT(farthest, 2.48);  // no vertex stands on the axis of the molecule
}

TEST(Swarm, TheSameSeedIsTheSameSwarmWhateverMoves) {
  SwarmContent swarm;
  swarm.count = 30;
  const layers::Scene all = scene_of(swarm);
  swarm.moving_percent = 10;
  const layers::Scene few = scene_of(swarm);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(place(all.at(0), i), place(few.at(0), i));
  swarm.seed = 2;
  EXPECT_NE(place(scene_of(swarm).at(0), 0), place(few.at(0), 0));
}

const std::vector<std::string> kRight = {"frames: 10", "fps: 30", "display: [64, 64]",
                                         "swarm: {count: 5, shape: quad}",
                                         "layers: [{name: all, parts: [\"swarm/*\"]}]"};

TEST(Swarm, BadInputIsRefusedWithFileLineAndRule) {
  const tests::TemporaryFolder folder;
  const auto load = [&](const std::vector<std::string>& lines) {
    return load_sequence(folder.write("test.yaml", tests::text_of(lines)));
  };
  EXPECT_EQ(load(kRight).scene->parts.size(), 5u);
  tests::expect_refused(kRight,
                        {{4, "swarm: {count: 0}", "from 1 to 1000000"},
                         {4, "swarm: {count: -3}", "from 1 to 1000000"},
                         {4, "swarm: {count: 1000000000}", "from 1 to 1000000"},
                         {4, "swarm: {count: 1e9}", "from 1 to 1000000"},
                         {4, "swarm: {moving: 101}", "from 0 to 100"},
                         {4, "swarm: {moving: -1}", "from 0 to 100"},
                         {4, "swarm: {translation: .nan}", "swarm.translation"},
                         {4, "swarm: {rotation_deg: .inf}", "swarm.rotation_deg"},
                         {4, "swarm: {cube: 0}", "swarm.cube"},
                         {4, "swarm: {shape: ball}", "quad, block, sphere"},
                         {4, "swarm: {count: 1000000, translation: 1e9, cube: 1e-9}", "20 million"},
                         {4, "swarm: {colour: 3}", "colour"}},
                        load);
}

TEST(Swarm, TheScenariosOfTheThesisLoad) {
  for (const std::string name : {"random", "blocks", "particles", "molecules"}) {
    const Sequence sequence = load_sequence("fearing/" + name);
    EXPECT_EQ(sequence.scene->parts.size(), 1000u) << name;
    EXPECT_EQ(sequence.scene->lights.size(), 5u);
    EXPECT_EQ(sequence.frames, 100);
    EXPECT_TRUE(sequence.warnings.empty()) << name;
  }
}

}  // namespace
}  // namespace talisman::sequences
