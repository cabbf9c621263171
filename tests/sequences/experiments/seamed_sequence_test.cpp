// SPDX-License-Identifier: Apache-2.0
// Settings of one sequence beside each other: each has the seams that it would have alone.
#include "sequences/experiments/seamed_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/lod/levels.h"
#include "sequences/experiments/regulator/cut_layers.h"
#include "sequences/experiments/regulator/setting_run.h"
#include "sequences/experiments/regulator/stored_runs.h"
#include "sequences/experiments/tuning/thresholds.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/results/planned.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using ::testing::Gt;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

/// Two tiles that meet at x = 0, and a camera that flies over the edge.
constexpr const char* kTiles = R"(frames: 12
display: [128, 96]
seam: auto
regulator: {geometric_px: 1}
camera: {fov_deg: 50, near_m: 0.5, far_m: 200, flight: [
  {t: 0, position: [-3, 4, 9], target: [0, 0, 0]}, {t: 1, position: [4, 3, 6], target: [1, 0, -1]}]}
shapes:
  - {id: "west*", plane: [8, 8], position: [-4, 0, 0]}
  - {id: east, plane: [8, 8], position: [4, 0, 0]}
)";

class Seamed : public ::testing::Test {
 protected:
  Sequence read(std::optional<double> geometric_px, std::optional<layers::ivec2> display_px = {}) const {
    ContentOptions options;
    options.geometric_px = geometric_px;
    options.display_px = display_px;
    return load_sequence(file_, options);
  }
  static Settings at(const Sequence& sequence, double geometric_px) {
    Settings settings = tests::run_of(sequence).settings;
    settings.regulator.thresholds.geometric_px = geometric_px;
    return settings;
  }
  static std::vector<layers::dvec3> seam_vertices(const Sequence& sequence) {
    std::vector<layers::dvec3> all;
    for (const layers::Part& part : sequence.scene->parts)
      if (part.is_seam)
        for (const auto& p : sequence.scene->meshes[part.mesh].positions) all.emplace_back(p);
    return all;
  }
  static void expect_same(const Sequence& a, const Sequence& b) {
    EXPECT_EQ(seam_vertices(a), seam_vertices(b));
    ASSERT_EQ(a.layers.layers.size(), b.layers.layers.size());
    for (std::size_t i = 0; i < a.layers.layers.size(); ++i) {
      EXPECT_EQ(a.layers.layers[i].parts, b.layers.layers[i].parts);
      EXPECT_EQ(a.layer_specs[i].part_globs, b.layer_specs[i].part_globs);
    }
  }

  TemporaryFolder folder_;
  std::string file_ = folder_.write("tiles.yaml", kTiles);
};

TEST_F(Seamed, AreThoseOfTheSequenceReadForThatThreshold) {
  const Sequence sequence = read({});
  const Sequence wide = with_seams_for(sequence, at(sequence, 8));
  EXPECT_NE(seam_vertices(wide), seam_vertices(sequence));
  expect_same(wide, read(8));
  expect_same(with_seams_for(wide, at(sequence, 1)), sequence);
}

TEST_F(Seamed, OfAnotherDisplayAreThoseReadForThat) {
  const Sequence sequence = read({});
  Settings settings = at(sequence, 1);
  settings.view.display_px = {512, 384};
  expect_same(with_seams_for(sequence, settings), read({}, layers::ivec2(512, 384)));
}

TEST_F(Seamed, WithoutSeamsItIsTheVerySameScene) {
  const Sequence sequence = tests::moving_sequence(4);
  EXPECT_EQ(with_seams_for(sequence, at(sequence, 9)).scene, sequence.scene);
}

/// The levels of detail are of the scene that is planned: a piece of a cut layer has a ladder of its own.
TEST_F(Seamed, LevelsAreThoseOfTheSceneWithItsSeamsAndCuts) {
  const std::string ball =
      "frames: 12\ndisplay: [128, 96]\nseam: auto\n"
      "regulator: {policy: threshold, geometric_px: 1, lod: static, px_per_polygon: 8}\n"
      "camera: {fov_deg: 50, near_m: 0.5, far_m: 200, flight: ["
      "{t: 0, position: [0, 0, 30], target: [0, 0, 0]}, {t: 0.5, position: [0, 0, 5], target: [1, 0, -1]}]}\n"
      "shapes:\n  - {id: ball, sphere: 2, segments: 64}\n  - {id: other, sphere: 1, position: [3, 0, 0]}\n";
  const Sequence sequence = load_sequence(folder_.write("ball.yaml", ball));
  const Sequence cut = with_seams_for(with_cut_layers(sequence, 4), at(sequence, 2));
  ASSERT_NE(cut.scene->levels, nullptr);
  EXPECT_EQ(cut.layers.layers.size(), 8u) << "both are cut in four";
  const layers::Scene own = layers::without_levels(*cut.scene);
  EXPECT_EQ(cut.scene->levels->parts.size(), own.parts.size());
  EXPECT_EQ(cut.scene->levels->ladders.size(), own.meshes.size());
  for (const layers::Layer& layer : cut.layers.layers) {
    ASSERT_GT(layers::level_count(*cut.scene, layer), 1) << layer.name;
    const layers::Layer coarse = layers::layer_at_level(*cut.scene, layer, 1);
    EXPECT_TRUE(cut.scene->parts[coarse.parts[0]].is_level);
    EXPECT_EQ(cut.scene->parts[coarse.parts[0]].name, cut.scene->parts[layer.parts[0]].name);
  }
  // Far away the coarser ones are drawn, and cost less.
  Settings finest = at(sequence, 2);
  finest.regulator.lod.by = regulator::LodSelector::None;
  const auto polygons = [&](const Settings& settings) {
    return planned(with_cut_layers(sequence, 4), settings, {0, 0}).polygons_rendered();
  };
  EXPECT_GT(polygons(at(sequence, 2)), 0);
  EXPECT_LT(polygons(at(sequence, 2)), polygons(finest));
}

TEST_F(Seamed, RunBesideOthersCountsWhatItWouldAlone) {
  const Sequence sequence = read({}), alone = read(6);
  const chunker::PreparedScene prepared(*sequence.scene), prepared_alone(*alone.scene);
  const Settings base = at(sequence, 1), settings = at(alone, 6);
  SettingRun beside(sequence, base, {"6 px", "", 6, settings.regulator});
  SettingRun own(alone, settings, {"6 px", "", 6, settings.regulator});
  std::int64_t pixels = 0;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    beside.advance(frame, &prepared);
    own.advance(frame, &prepared_alone);
    beside.count();
    own.count();
    ASSERT_EQ(beside.pictures().now.rgb, own.pictures().now.rgb) << frame;
    pixels += beside.summary().frames.back().pixels.rendered;
  }
  EXPECT_EQ(pixels, own.result().pixels);
  EXPECT_THAT(pixels, Gt(0));
  EXPECT_NE(planned(sequence, base, {0, 11}).pixels_rendered(), pixels);
}

TEST_F(Seamed, WhatIfPlansAndTriedThresholdsHaveTheirs) {
  const Sequence sequence = read({});
  const Summary alone = planned(read(6), at(sequence, 6), {0, 11});
  EXPECT_EQ(planned(sequence, at(sequence, 6), {0, 11}).pixels_rendered(), alone.pixels_rendered());
  expect_same(with_thresholds(sequence, at(sequence, 1), {6, {}}).sequence, read(6));
}

TEST_F(Seamed, StoredRunOfAPointCountsWhatThePointDoes) {
  if (!has_report()) GTEST_SKIP() << "a build without the report";
  const Sequence sequence = read({});
  RegulatorReport report;
  report.given = at(sequence, 1);
  report.frames = {0, 11, 1};
  report.settings.resize(1);
  report.settings[0].setting = {"threshold", "px", 6, at(sequence, 6).regulator};
  store_runs(sequence, report, folder_.path());
  const Summary alone = planned(read(6), at(sequence, 6), {0, 11});
  EXPECT_NE(alone.polygons_rendered(), planned(sequence, at(sequence, 1), {0, 11}).polygons_rendered());
  EXPECT_THAT(folder_.read(report.runs.at(0)),
              HasSubstr("Would draw " + std::to_string(alone.polygons_rendered()) + " of "));
}

}  // namespace
}  // namespace talisman::sequences
