// SPDX-License-Identifier: Apache-2.0
// Layers of what moves as one, whatever the tree of nodes says.
#include "sequences/content/factoring/motion_groups.h"

#include <fstream>

#include <gmock/gmock.h>

#include "sequences/content/sequence.h"
#include "sequences/files/errors.h"
#include "tests/sequences/content/factoring/factored_scene.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman {
namespace {

using sequences::FactoringStudy;
using sequences::FactoringWay;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;
using tests::dvec3;
using tests::FactoredScene;

/// Two cubes on nodes of their own that drift alike, two that stand far apart, one that turns, and its child.
FactoredScene rigs() {
  FactoredScene s;
  for (const char* name : {"left wing", "right wing"}) {
    const int node = s.part(name, {name[0] == 'l' ? -2.0 : 2.0, 0, 0});
    s.moves(node, {0.02, 0.01, 0});
  }
  s.part("house", {-4, -3, 0});
  s.part("hill", {4, 3, 0});
  const int rotor = s.part("rotor", {0, 3, 0});
  s.spins(rotor, 0.3);
  s.part("lamp", {0.5, 0, 0}, rotor);
  return s;
}

TEST(MotionGroups, PartsThatMoveAsOneAreOneLayerWhereverTheyHang) {
  const FactoredScene s = rigs();
  const FactoringStudy study = s.study(sequences::kMostLayers, FactoringWay::Motion);
  EXPECT_EQ(study.chosen.how, "motion");
  EXPECT_THAT(s.parts_of(study.chosen),
              UnorderedElementsAre(ElementsAre("left wing", "right wing"), ElementsAre("house", "hill"),
                                   ElementsAre("rotor", "lamp")));
}

TEST(MotionGroups, WhatPartsOnlyInTheLastFrameIsNoGroup) {
  FactoredScene s = rigs();
  auto& track = std::get<layers::TransformTrack>(s.scene.tracks[1].motion);
  track.translation.times_s.insert(track.translation.times_s.end() - 1, s.settings.frames - 2.0);
  track.translation.values.insert(
      track.translation.values.end() - 1,
      track.translation.values.front() + dvec3(0.02, 0.01, 0) * (s.settings.frames - 2.0));
  track.translation.values.back() += dvec3(0, 0.5, 0);
  const FactoringStudy study = s.study(sequences::kMostLayers, FactoringWay::Motion);
  EXPECT_EQ(s.parts_of(study.chosen).size(), 4u);
}

TEST(MotionGroups, NothingMovesAndOnePart) {
  FactoredScene still;
  still.part("a", {0, 0, 0});
  EXPECT_EQ(still.parts_of(still.study(sequences::kMostLayers, FactoringWay::Motion).chosen).size(), 1u);
  still.part("b", {1, 0, 0});
  EXPECT_EQ(still.parts_of(still.study(sequences::kMostLayers, FactoringWay::Motion).chosen).size(), 1u);
  // One frame: nothing is known to move.
  FactoredScene brief(1);
  brief.moves(brief.part("a", {0, 0, 0}), {1, 0, 0});
  brief.part("b", {1, 0, 0});
  EXPECT_EQ(brief.parts_of(brief.study(sequences::kMostLayers, FactoringWay::Motion).chosen).size(), 1u);
}

std::string swarm_file(const tests::TemporaryFolder& folder, const std::string& layers) {
  std::string path = folder.path() + "/swarm.yaml";
  std::ofstream(path) << "name: swarm\nframes: 8\nfps: 30\ndisplay: [64, 48]\n"
                         "swarm: {count: 20, shape: block, cube: 8, moving: 25, seed: 3}\n"
                         "camera: {position: [0, 0, 14], look_at: [0, 0, 0]}\n"
                      << layers << "\n";
  return path;
}

TEST(MotionGroups, OfASwarmWhatMovesIsAloneAndTheRestIsOne) {
  const tests::TemporaryFolder folder;
  const sequences::Sequence sequence = sequences::load_sequence(swarm_file(folder, "layers: {auto: motion}"));
  EXPECT_EQ(sequence.layers.layers.size(), 6u);  // 5 of 20 move
  EXPECT_EQ(sequence.layers.unassigned_parts, 0);
}

std::string motion_refusal(const std::string& path) {
  try {
    sequences::load_sequence(path);
  } catch (const sequences::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MotionGroups, TooManyAndALayerBesideThemAreRefused) {
  const tests::TemporaryFolder folder;
  EXPECT_THAT(
      motion_refusal(swarm_file(folder, "layers: {auto: motion, max: 5}")),
      ::testing::HasSubstr("layers: auto is 'motion', which makes a layer for each of 6 groups that move "
                           "as one, must be no more than max, which is 5"));
  const std::string in_list =
      motion_refusal(swarm_file(folder, "layers:\n  - {name: a, parts: [\"*\"]}\n  - {auto: motion}"));
  EXPECT_THAT(in_list, ::testing::HasSubstr("swarm.yaml:9"));
  const std::string with_parts = motion_refusal(swarm_file(folder, "layers: {auto: motion, parts: [\"*\"]}"));
  EXPECT_THAT(with_parts, ::testing::HasSubstr("swarm.yaml:7"));
  const std::string twice =
      motion_refusal(swarm_file(folder, "layers: {auto: motion}\nlayers:\n  - {name: a, parts: [\"*\"]}"));
  EXPECT_THAT(twice,
              ::testing::HasSubstr(
                  "swarm.yaml:9: layers is a list of 1, rule: each key only once, and it is in line 7"));
}

}  // namespace
}  // namespace talisman
