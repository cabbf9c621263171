// SPDX-License-Identifier: Apache-2.0
// Large parts: cut where an author says so, and where it pays.
#include "sequences/content/factoring/cuts.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "sequences/content/factoring/planned_factoring.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/sequence.h"
#include "sequences/files/errors.h"
#include "tests/sequences/content/factoring/factored_scene.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman {
namespace {

using sequences::CutStudy;
using sequences::InputError;
using sequences::Sequence;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;
using tests::FactoredScene;

/// A room of 8 × 8 × 8 m without a front, seen from within, each wall of 8 × 8 squares, as one mesh.
layers::Mesh room() {
  layers::Mesh mesh;
  const auto wall = [&](const layers::vec3& corner, const layers::vec3& u, const layers::vec3& v) {
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 8; ++k) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
          mesh.positions.push_back(corner + static_cast<float>(i + a) * u + static_cast<float>(k + b) * v);
          mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
        }
        for (const std::uint32_t at : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + at);
      }
  };
  wall({-4, -4, -4}, {1, 0, 0}, {0, 1, 0});  // back
  wall({-4, -4, 4}, {0, 0, -1}, {0, 1, 0});  // left
  wall({4, -4, -4}, {0, 0, 1}, {0, 1, 0});   // right
  wall({-4, -4, 4}, {1, 0, 0}, {0, 0, -1});  // floor
  wall({-4, 4, -4}, {1, 0, 0}, {0, 0, 1});   // ceiling
  return mesh;
}

/// The eye, in its open side, sways.
FactoredScene walk() {
  FactoredScene s;
  s.scene.meshes.push_back(room());
  s.part("room", {0, 0, 0}, -1, 2);
  s.settings.view.display_px = {400, 400};
  s.scene.nodes[s.eye()].local.translation.x = -1;
  s.moves(s.eye(), {0.08, 0, 0});
  return s;
}

TEST(Cuts, WhatOneWarpCarriesIsLeftWhole) {
  FactoredScene s;
  s.scene.meshes.push_back(room());
  s.moves(s.part("turned away", {-30, 0, -40}, -1, 2), {0.5, 0, 0});  // far off, sideways
  const CutStudy found = sequences::study_with_cuts({s.scene, {}, {}, s.settings}, {});
  EXPECT_THAT(found.cuts, IsEmpty());
  EXPECT_EQ(s.parts_of(found.study.chosen), s.parts_of(s.study().chosen));
}

TEST(Cuts, WhatDeformsOrHasAnothersNameIsLeftWhole) {
  FactoredScene twice = walk();
  twice.part("room", {0, 0, 6}, -1, 2);
  EXPECT_THAT(sequences::study_with_cuts({twice.scene, {}, {}, twice.settings}, {}).cuts, IsEmpty());
  FactoredScene bends;
  bends.scene = tests::skinned_bar_scene();
  EXPECT_THAT(sequences::study_with_cuts({bends.scene, {}, {}, bends.settings}, {}).cuts, IsEmpty());
}

/// Beyond what an author has: a ball as one part, cut by the file.
std::string ball_file(const std::string& more) {
  return "frames: 3\nfps: 24\ndisplay: [64, 48]\n"
         "camera: {position: [0, 0, 6], look_at: [0, 0, 0]}\n"
         "shapes:\n  - {id: ball, sphere: 1, color: [1, 0, 0]}\n  - {id: box, box: [1, 1, 1], position: [2, "
         "0, 0]}\n" +
         more;
}

class CutFile : public ::testing::Test {
 protected:
  Sequence load(const std::string& more) {
    return sequences::load_sequence(folder_.write("cut.yaml", ball_file(more)));
  }
  std::string refusal(const std::string& more) {
    try {
      load(more);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  tests::TemporaryFolder folder_;
};

TEST_F(CutFile, PartsAreCutBeforeLayersTakeThem) {
  const Sequence whole = load("");
  const Sequence cut = load(
      "cuts: [{parts: ball, into: 3}]\nlayers:\n"
      "  - {name: first, parts: [ball~1]}\n  - {name: rest, parts: ['ball~*', box]}\n");
  std::vector<std::string> names;
  int triangles = 0, triangles_before = 0;
  for (const layers::Part& part : cut.scene->parts) {
    names.push_back(part.name);
    triangles += cut.scene->meshes[part.mesh].triangle_count();
  }
  for (const layers::Part& part : whole.scene->parts)
    triangles_before += whole.scene->meshes[part.mesh].triangle_count();
  EXPECT_THAT(names, UnorderedElementsAre("ball~1", "ball~2", "ball~3", "box"));
  EXPECT_EQ(triangles, triangles_before);
  EXPECT_THAT(cut.layers.layers, SizeIs(2));
}

TEST_F(CutFile, WhatCannotBeCutIsRefused) {
  EXPECT_THAT(refusal("cuts: [{parts: bal, into: 3}]\n"), HasSubstr("'bal' matches no part"));
  EXPECT_THAT(refusal("cuts: [{parts: bal, into: 3}]\n"), HasSubstr("did you mean 'ball'"));
  EXPECT_THAT(refusal("cuts: [{parts: ball, into: 1}]\n"), HasSubstr("into"));
  EXPECT_THAT(refusal("cuts: [{parts: ball, into: 65}]\n"), HasSubstr("into"));
  EXPECT_THAT(refusal("cuts: [{parts: ball}]\n"), HasSubstr("into"));
  EXPECT_THAT(refusal("cuts: [{into: 4}]\n"), HasSubstr("parts"));
}

/// A land of one part, over which the eye flies low: its pieces are layers, and no crack opens between them.
TEST_F(CutFile, WhatIsCutUnaskedReachesOverItsEdges) {
  const std::string land =
      "frames: 24\nfps: 24\ndisplay: [100, 100]\n"
      "camera: {fov_deg: 60, near_m: 0.1, flight: [{t: 0, position: [0, 2, 40], target: [0, 1, 0]},"
      " {t: 1, position: [0, 2, 34], target: [0, 1, -6]}]}\n"
      "shapes:\n  - {id: land, plane: [60, 80], segments: 32, color: [0.2, 0.4, 0.1]}\n"
      "regulator: {geometric_px: 1}\n";
  const Sequence sequence =
      sequences::load_sequence(folder_.write("land.yaml", land + "layers: {auto: velocity}\n"));
  ASSERT_NE(sequence.scene->parts.front().name, "land");
  EXPECT_EQ(sequence.seam, sequences::Seam::Auto);
  EXPECT_TRUE(sequence.scene->parts.back().is_seam);
  EXPECT_THAT(sequence.notes, ::testing::Contains(HasSubstr("part 'land' is cut into")));
  const Sequence whole = sequences::load_sequence(folder_.write("whole.yaml", land));
  const auto work_ms = [](const Sequence& of) {
    return sequences::plan_of(*of.scene, of.layers, {}, sequences::own_settings(of), of.frames).work_ms();
  };
  EXPECT_GT(sequence.layers.layers.size(), 1U);
  EXPECT_LT(work_ms(sequence), 0.9 * work_ms(whole)) << "with what its seams cost";
}

TEST(Cuts, AreWrittenAsTheyAreRead) {
  EXPECT_EQ(sequences::cuts_yaml({}), "");
  EXPECT_EQ(sequences::cuts_yaml({{"hall", 4, "", 0}, {"a: b", 2, "", 0}}, "house/"),
            "cuts:\n  - {parts: house/hall, into: 4}\n  - {parts: \"house/a: b\", into: 2}\nseam: auto\n");
}

}  // namespace
}  // namespace talisman
