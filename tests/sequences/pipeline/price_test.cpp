// SPDX-License-Identifier: Apache-2.0
// What a frame costs is what was drawn for it: sprites, mirrored pictures, shadow maps; and a budget binds it.
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/budget.h"
#include "sequences/pipeline/depth_complexity.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/summary.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;
using ::testing::HasSubstr;

/// A ball of 3,968 triangles flies over a floor of two, on which it casts a shadow.
constexpr const char* kBallOverFloor = R"(
name: ball
frames: 24
fps: 24
display: [160, 120]
background: "#000000"
shapes:
  - {id: floor, plane: [8, 8], color: "#ffffff"}
  - {id: ball, sphere: 1, segments: 64, color: "#808080", flight: [
      {t: 0, position: [-1, 1, 0], target: [99, 1, 0]}, {t: 1, position: [1, 1, 0], target: [99, 1, 0]}]}
camera: {fov_deg: 40, near_m: 0.1, far_m: 60, position: [0, 5, 7], look_at: [0, 0, 0]}
lights:
  - {kind: directional, name: sun, direction: [1, -1, 0], color: [0.5, 0.5, 0.5], casts_shadow: true}
layers:
  - {name: floor, parts: [floor], group: background, shading: {shadows: {}}}
  - {name: ball, parts: [ball]}
)";

Variant ball_over_floor() {
  const tests::TemporaryFolder folder;
  return tests::run_of(load_sequence(folder.write("case.yaml", kBallOverFloor)));
}

std::vector<FrameReport> play(const Variant& variant, int frames, bool draw = false) {
  return tests::Playback(variant.sequence, variant.settings, draw).all(frames);
}

/// Sum over all rows of decisions.jsonl.
regulator::LayerCost spent(const FrameReport& report) {
  regulator::LayerCost sum;
  const auto add = [&sum](const regulator::LayerDecision& d) {
    sum.polygons += d.cost.polygons;
    sum.pixels += d.cost.pixels;
    sum.chunks += d.cost.chunks;
  };
  for (const regulator::LayerDecision& d : report.plan.decisions) add(d);
  for (const ShadowMapRow& map : report.shadow_maps) add(map.decision);
  return sum;
}

bool anything_appears(const FrameReport& report) {
  for (const regulator::LayerAssessment& a : report.assessments)
    if (a.in_view && !a.has_sprite) return true;
  for (const ShadowMapRow& map : report.shadow_maps)
    if (map.assessment.in_view && !map.assessment.has_sprite) return true;
  return false;
}

/// Frames without a first appearance keep the budget; one that has some spends no more than these beyond it.
/// Returns the number of frames that overdrew it.
int expect_budget_kept(const std::vector<FrameReport>& reports, const regulator::Budget& budget,
                       const std::string& what) {
  int overdrawn = 0;
  for (const FrameReport& report : reports) {
    const regulator::LayerCost cost = spent(report);
    EXPECT_EQ(line_of(report).polygons.rendered, cost.polygons) << what << ", frame " << report.frame;
    EXPECT_EQ(line_of(report).pixels.rendered, cost.pixels) << what << ", frame " << report.frame;
    if (budget.affords(cost)) continue;
    ++overdrawn;
    EXPECT_TRUE(anything_appears(report)) << what << ", frame " << report.frame << ": " << cost.polygons
                                          << " polygons, " << cost.pixels << " pixels";
  }
  return overdrawn;
}

TEST(Price, RowsOfAFrameAddUpToItsTotals) {
  for (const Policy policy : {Policy::Reference, Policy::Threshold, Policy::Lookahead, Policy::Hold}) {
    Variant variant = tests::every_effect(8);
    variant.settings.regulator.policy = policy;
    expect_budget_kept(play(variant, 8), {}, std::string(regulator::name(policy)));
  }
}

TEST(Price, ShadowMapIsARowWithPolygonsPixelsAndReason) {
  const Variant variant = ball_over_floor();
  tests::Playback playback(variant.sequence, variant.settings);
  const FrameReport first = playback.next();
  ASSERT_EQ(first.shadow_maps.size(), 1u);
  const std::vector<DecisionRow> rows = decision_rows(playback.state, first);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[3].name, "shadow map of sun");
  EXPECT_EQ(rows[3].decision.reason, "first_appearance");
  EXPECT_EQ(rows[3].decision.cost.polygons, 3970) << "ball and floor";
  EXPECT_EQ(rows[3].decision.cost.pixels, 1024 * 1024);
  EXPECT_THAT(json_of(rows[3]), HasSubstr(R"("layer":"shadow map of sun")"));
}

TEST(Price, ReferenceIsThatOfThePolicyWhateverTheRunDoes) {
  for (const Variant& variant : {ball_over_floor(), tests::every_effect(12)}) {
    Variant reference = variant;
    reference.settings.regulator.policy = Policy::Reference;
    const auto truth = play(reference, 12);
    for (const Policy policy : {Policy::Threshold, Policy::Hold, Policy::Budget, Policy::Lookahead}) {
      Variant other = variant;
      other.settings.regulator.policy = policy;
      other.settings.regulator.budget.polygons = 1000;
      const auto reports = play(other, 12);
      for (int frame = 0; frame < 12; ++frame) {
        EXPECT_EQ(reports[frame].reference.polygons, line_of(truth[frame]).polygons.rendered)
            << regulator::name(policy) << " " << frame;
        EXPECT_EQ(reports[frame].reference.pixels, line_of(truth[frame]).pixels.rendered)
            << regulator::name(policy) << " " << frame;
      }
    }
  }
}

TEST(Price, BudgetOfPolygonsHoldsShadowMapsToo) {
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Budget;
  variant.settings.regulator.budget.polygons = 2000;
  tests::Playback playback(variant.sequence, variant.settings);
  Summary summary = start_summary(playback.pipeline, "ball");
  for (int frame = 0; frame < 24; ++frame) {
    const FrameReport report = playback.next();
    add_decisions(summary, report, playback.state);
    summary.frames.push_back(line_of(report));
    if (frame == 0) continue;  // everything appears
    EXPECT_LE(line_of(report).polygons.rendered, 2000) << frame;
  }
  const std::string table = table_of(summary);
  EXPECT_THAT(table, HasSubstr("ball: dearer than the whole budget in 23 frames"));
  EXPECT_THAT(table, HasSubstr("shadow map of sun: dearer than the whole budget in 23 frames"));
  const auto json = json_of(summary);
  EXPECT_THAT(json, HasSubstr(R"("frames_over_budget": 23)"));
  // What is not drawn again is off, and the rows say by how much.
  EXPECT_GT(summary.layers[2].max_geometric_px, 20);
  EXPECT_GT(summary.layers[1].max_geometric_px, 20) << "the shadow on the floor stands still, too";
  EXPECT_GE(summary.shadow_maps[0].max_geometric_px, summary.layers[1].max_geometric_px)
      << "the farthest of all that look it up";
}

TEST(Price, BudgetOfTimeHoldsTheModelledTime) {
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Budget;
  variant.settings.regulator.budget.ms = 3;
  const auto reports = play(variant, 24, true);
  int maps = 0, balls = 0;
  for (int frame = 1; frame < 24; ++frame) {
    EXPECT_LE(line_of(reports[frame]).modelled_ms, 3) << frame;
    maps += reports[frame].shadow_maps[0].pictures;
    balls += reports[frame].plan.decisions[2].action == Action::Rerender;
  }
  EXPECT_GT(maps, 0) << "either of them can be paid, though not both";
  EXPECT_GT(balls, 0);
}

// A shadow drawn from an old map is where the map's instant put it: the picture is that of the old shadow, and the
// error that is stated is what it has moved since.
TEST(Price, SpriteDrawnFromAnOldMapStatesTheErrorOfItsShadow) {
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Threshold;
  variant.settings.regulator.thresholds.geometric_px = 0.5;
  variant.settings.regulator.thresholds.shadow_map_px = 1000;
  tests::Playback playback(variant.sequence, variant.settings, true);
  const auto reports = playback.all(8);
  EXPECT_EQ(playback.state.memory[1].maps.size(), 1u);
  const regulator::LayerDecision& shadow = reports[4].plan.decisions[1];
  EXPECT_EQ(shadow.action, Action::Rerender);
  EXPECT_GT(shadow.shown_geometric_px, 3);
  EXPECT_EQ(reports[4].shadow_maps[0].pictures, 0);
  EXPECT_GE(reports[4].shadow_maps[0].decision.shown_geometric_px, shadow.shown_geometric_px);
}

TEST(Price, LateDrawingOfASpriteFromAnOldMapGivesTheSamePicture) {
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Budget;
  variant.settings.regulator.budget.ms = 3;
  const auto whole = play(variant, 12, true);
  tests::Playback planned(variant.sequence, variant.settings);
  planned.all(11);
  const chunker::PreparedScene prepared(*variant.sequence.scene);
  const FrameReport last = step(planned.pipeline, planned.state, 11, &prepared);
  EXPECT_EQ(hash_of(last.picture), hash_of(whole[11].picture));
}

TEST(Price, MirroredPicturesAreCharged) {
  Variant variant = tests::every_effect(2);
  variant.settings.regulator.policy = Policy::Reference;
  const auto reports = play(variant, 1, true);
  int mirrors = 0;
  for (const layers::Layer& layer : reports[0].layers) {
    const regulator::LayerDecision& d = reports[0].plan.decisions[layer.id];
    if (!layer.holds.reflection || d.action != Action::Rerender) continue;
    ++mirrors;
    const auto sprite = d.cost.bytes / static_cast<std::int64_t>(sizeof(chunker::Chunk));
    EXPECT_GT(d.cost.chunks, sprite) << layer.name;
  }
  EXPECT_GT(mirrors, 0);
}

TEST(Price, BudgetsAreKeptOverAllEffectsWithEitherChoice) {
  for (const auto choice : regulator::kAllChoiceRules)
    for (const std::int64_t polygons : {200, 600, 2000}) {
      Variant variant = tests::every_effect(24);
      variant.settings.regulator.policy = Policy::Budget;
      variant.settings.regulator.budget.polygons = polygons;
      variant.settings.regulator.budget.pixels = 60 * polygons;
      variant.settings.regulator.budget.choice = choice;
      expect_budget_kept(play(variant, 24), regulator::frame_budget(variant.settings.regulator),
                         std::string(regulator::name(choice)) + " " + std::to_string(polygons));
    }
}

TEST(DepthComplexity, CountsWhatFacesTheEyeOnce) {
  // A ball of diameter 1 m at 8.12 m, seen at 60 px / tan 20 deg: a disc of radius 10.15 px. Its back is turned away.
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Reference;
  tests::Playback playback(variant.sequence, variant.settings);
  playback.next();
  const double filled = texels_filled(playback.pipeline, playback.pipeline.scene.at(0),
                                      playback.pipeline.authored[2], playback.state.memory[2].placement);
  EXPECT_NEAR(filled, 323.6, 0.08 * 323.6);
}

TEST(DepthComplexity, IsFedBackIntoABudgetOfTimeAlone) {
  Variant variant = ball_over_floor();
  variant.settings.regulator.policy = Policy::Budget;
  variant.settings.regulator.budget.polygons = 2000;
  for (const FrameReport& report : play(variant, 3)) EXPECT_EQ(report.depth_complexity, 1);
  variant.settings.regulator.budget.ms = 3;
  variant.settings.regulator.budget.depth_complexity = 2;
  for (const FrameReport& report : play(variant, 3)) EXPECT_EQ(report.depth_complexity, 2);
}

TEST(Price, BudgetsAreKeptInScenesDrawnByLot) {
  const tests::TemporaryFolder folder;
  tests::write_checker(folder.path());
  int frames = 0, overdrawn = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    Variant variant = tests::run_of(tests::random_sequence(seed, folder.path()));
    variant.settings.regulator.policy = Policy::Budget;
    variant.settings.regulator.budget.polygons = 300 + 100 * (seed % 5);
    variant.settings.regulator.budget.pixels = 40'000;
    variant.settings.regulator.budget.choice = regulator::kAllChoiceRules[seed % 2];
    const auto reports = play(variant, variant.sequence.frames);
    frames += static_cast<int>(reports.size());
    overdrawn += expect_budget_kept(reports, regulator::frame_budget(variant.settings.regulator),
                                    "seed " + std::to_string(seed));
  }
  std::printf("%d of %d frames beyond their budget, by first appearances\n", overdrawn, frames);
}

}  // namespace
}  // namespace talisman::sequences
