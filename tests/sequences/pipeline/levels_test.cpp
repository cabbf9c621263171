// SPDX-License-Identifier: Apache-2.0
// Levels of detail through the whole pipeline: what is chosen is what is drawn and paid for, within the budget.
#include "layers/lod/levels.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/options.h"
#include "sequences/pipeline/lod/levels_now.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::FirstAppearance;
using regulator::LodBenefit;
using regulator::LodSelector;
using ::testing::HasSubstr;
using tests::Playback;
using tests::TemporaryFolder;

/// Balls of some 2,000 triangles in two rows, past which the camera flies: they come into view one after the other.
std::string balls(const std::string& regulator) {
  std::string yaml =
      "frames: 48\nfps: 24\ndisplay: [160, 120]\n"
      "camera: {fov_deg: 60, near_m: 0.1, far_m: 100, flight: [{t: 0, position: [0, 0, 8], target: [0, 0, "
      "-50]},"
      " {t: 1, position: [0, 0.5, 0], target: [2, 0, -50]}, {t: 2, position: [0.5, 0, -6], target: [-40, 0, "
      "-30]}]}\n"
      "lights:\n  - {kind: directional, direction: [0, -1, -1]}\n"
      "regulator: {" +
      regulator + "}\nshapes:\n";
  std::string layers = "layers:\n";
  for (int i = 0; i < 12; ++i) {
    const std::string id = "ball" + std::to_string(i);
    yaml += "  - {id: " + id + ", sphere: 0.8, segments: 48, position: [" + (i % 2 ? "1.5" : "-1.5") +
            ", 0, " + std::to_string(5 - 2 * i) + "]}\n";
    layers += "  - {name: " + id + ", parts: [" + id + "]}\n";
  }
  return yaml + layers;
}

Sequence sequence_with(const std::string& regulator) {
  const TemporaryFolder folder;
  return load_sequence(folder.write("scene.yaml", balls(regulator)));
}

Settings settings_of_run(const Sequence& sequence) { return resolve({}, sequence, true).settings; }

std::vector<FrameReport> played(const std::string& regulator, bool draw = false) {
  const Sequence sequence = sequence_with(regulator);
  return Playback(sequence, settings_of_run(sequence), draw).all(sequence.frames);
}

/// The levels of a ball: as many as simplification keeps in shape.
int levels_of_a_ball() {
  const Sequence with = sequence_with("policy: threshold, lod: static");
  return layers::level_count(*with.scene, with.layers.layers[0]);
}

std::string decisions_of(const FrameReport& report) {
  std::string text;
  for (const regulator::LayerDecision& decision : report.plan.decisions)
    text += json_of(report, decision) + "\n";
  return text;
}

TEST(LevelsOfAScene, AreTakenByNoLayerAndGoAsTheyCame) {
  const Sequence plain = sequence_with("policy: threshold"),
                 with = sequence_with("policy: threshold, lod: static");
  ASSERT_EQ(plain.scene->levels, nullptr);
  ASSERT_NE(with.scene->levels, nullptr);
  EXPECT_EQ(with.layers.layers.size(), plain.layers.layers.size());
  EXPECT_EQ(with.layers.unassigned_parts, 0);
  EXPECT_EQ(with.scene->parts.size(),
            static_cast<std::size_t>(levels_of_a_ball()) * plain.scene->parts.size());
  const layers::Scene back = layers::without_levels(*with.scene);
  EXPECT_EQ(back.parts.size(), plain.scene->parts.size());
  EXPECT_EQ(back.meshes.size(), plain.scene->meshes.size());
  const layers::Layer& ball = with.layers.layers[0];
  const std::vector<layers::LadderLevel>& ladder =
      with.scene->levels
          ->ladders[static_cast<std::size_t>(with.scene->parts[static_cast<std::size_t>(ball.parts[0])].mesh)]
          .levels;
  EXPECT_EQ(ladder.size(), static_cast<std::size_t>(levels_of_a_ball()));
  EXPECT_GE(ladder.size(), 4u);
  for (std::size_t k = 1; k < ladder.size(); ++k) EXPECT_LE(2 * ladder[k].triangles, ladder[k - 1].triangles);
  EXPECT_EQ(layers::factor(*with.scene, with.layer_specs).layers[0].parts, ball.parts)
      << "also when factored again";
  const layers::Layer coarse = layers::layer_at_level(*with.scene, ball, 99);
  EXPECT_TRUE(with.scene->parts[static_cast<std::size_t>(coarse.parts[0])].is_level);
}

/// Twice as large in the world, twice the error.
TEST(LevelsOfAScene, ErrorsAreThoseOfTheWorld) {
  const Sequence with = sequence_with("policy: threshold, lod: static");
  const layers::Layer& ball = with.layers.layers[0];
  const auto error_m = [&](const layers::dmat4& world) {
    return layers::level_of(*with.scene, ball, 2, {world}).error_m;
  };
  EXPECT_GT(error_m(layers::dmat4(1)), 0);
  EXPECT_DOUBLE_EQ(error_m(layers::dmat4(2)), 2 * error_m(layers::dmat4(1)));
  layers::dmat4 skewed(1);
  skewed[1][0] = 1;  // stretches by the golden ratio
  EXPECT_GE(error_m(skewed), 1.618 * error_m(layers::dmat4(1)));
  EXPECT_EQ(layers::level_of(*with.scene, ball, 0, {layers::dmat4(1)}).error_m, 0);
}

TEST(Levels, ThatAreThereAndNotAskedForChangeNothing) {
  const Sequence plain = sequence_with("policy: threshold"),
                 with = sequence_with("policy: threshold, lod: static");
  Settings settings = settings_of_run(with);
  settings.regulator.lod.by = LodSelector::None;
  const auto a = Playback(plain, settings_of_run(plain), true).all(plain.frames);
  const auto b = Playback(with, settings, true).all(with.frames);
  for (std::size_t f = 0; f < a.size(); ++f) {
    EXPECT_EQ(decisions_of(a[f]), decisions_of(b[f]));
    EXPECT_EQ(hash_of(a[f].picture), hash_of(b[f].picture));
  }
}

TEST(Levels, StaticDrawsWhatItPaysForAndFarBallsCoarser) {
  const auto reports = played("policy: reference, lod: static, px_per_polygon: 1", true);
  const std::string of_all = " of " + std::to_string(levels_of_a_ball());
  std::set<int> levels;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != Action::Rerender) continue;
      levels.insert(decision.level);
      EXPECT_EQ(report.render_by_layer[static_cast<std::size_t>(decision.layer)].polygons_in,
                decision.cost.polygons);
      EXPECT_EQ(decision.level > 0, decision.shown_geometric_px > 0);
      EXPECT_THAT(decision.reason, HasSubstr("; level " + std::to_string(decision.level) + of_all));
    }
  EXPECT_GE(levels.size(), 3u);
}

/// Balls of two rows and both sides of the camera's way, in layers of four.
std::string balls_in_fours(const std::string& regulator) {
  const std::string yaml = balls(regulator);
  std::string layers = "layers:\n";
  for (int i = 0; i < 12; i += 4) {
    layers += "  - {name: four" + std::to_string(i) + ", parts: [";
    for (int k = i; k < i + 4; ++k) layers += (k > i ? ", ball" : "ball") + std::to_string(k);
    layers += "]}\n";
  }
  return yaml.substr(0, yaml.find("layers:\n")) + layers;
}

std::vector<FrameReport> played_in_fours(const std::string& regulator) {
  const TemporaryFolder folder;
  const Sequence sequence = load_sequence(folder.write("scene.yaml", balls_in_fours(regulator)));
  return Playback(sequence, settings_of_run(sequence), true).all(sequence.frames);
}

/// What a sprite does not show is neither drawn nor paid for, and no pixel is another one.
TEST(MemberLevels, LeaveOutWhatASpriteDoesNotShow) {
  const auto whole = played_in_fours("policy: reference");
  const auto shown = played_in_fours("policy: reference, lod: static, px_per_polygon: 0");
  std::int64_t of_whole = 0, of_shown = 0;
  for (std::size_t f = 0; f < whole.size(); ++f) {
    EXPECT_EQ(hash_of(whole[f].picture), hash_of(shown[f].picture)) << f;
    for (const regulator::LayerDecision& decision : whole[f].plan.decisions)
      of_whole += decision.cost.polygons;
    for (const regulator::LayerDecision& decision : shown[f].plan.decisions) {
      of_shown += decision.cost.polygons;
      if (decision.action != Action::Rerender) continue;
      EXPECT_EQ(decision.level, 0);
      EXPECT_EQ(shown[f].render_by_layer[static_cast<std::size_t>(decision.layer)].polygons_in,
                decision.cost.polygons);
    }
  }
  EXPECT_LT(of_shown, of_whole);
}

/// A layer of four balls, each of which has four levels at most: by rungs it fits where one level for all would not.
TEST(MemberLevels, HoldTheBudgetAndDrawWhatTheyPayFor) {
  const auto reports = played_in_fours("policy: budget, budget_ms: 1, lod: optimise");
  std::set<int> rungs;
  for (const FrameReport& report : reports) {
    if (report.plan.lod->fits) {
      EXPECT_LE(planned_drawing_ms(report), 1 + 1e-9) << report.frame;
    }
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != Action::Rerender) continue;
      rungs.insert(decision.level);
      EXPECT_EQ(report.render_by_layer[static_cast<std::size_t>(decision.layer)].polygons_in,
                decision.cost.polygons);
    }
    for (const regulator::LayerAssessment& layer : report.assessments)
      for (std::size_t k = 1; k < layer.levels.size(); ++k) {
        if (layer.levels[k].resolution != layer.levels[k - 1].resolution) continue;
        EXPECT_LE(layer.levels[k].cost.polygons, layer.levels[k - 1].cost.polygons);
        EXPECT_GE(layer.levels[k].error_px, layer.levels[k - 1].error_px);
      }
  }
  EXPECT_GE(rungs.size(), 2u);
}

/// A level changes only with a render, and what is said of a reused sprite is its warp's error and its level's.
TEST(Levels, StayWithTheirSprites) {
  const auto reports = played("policy: threshold, geometric_px: 2, lod: static, px_per_polygon: 4");
  std::vector<int> level(12, 0);
  int reused = 0;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      int& then = level[static_cast<std::size_t>(decision.layer)];
      if (decision.action == Action::Reuse) {
        EXPECT_EQ(decision.level, then);
        EXPECT_GE(decision.shown_geometric_px,
                  report.assessments[static_cast<std::size_t>(decision.layer)].level_then_px - 1e-9);
        ++reused;
      }
      if (decision.action == Action::Rerender) then = decision.level;
    }
  EXPECT_GT(reused, 50);
}

TEST(Levels, OptimiseHoldsItsBudgetInEveryFrame) {
  for (const std::string first : {"coarsest", "skip"}) {
    const auto reports =
        played("policy: budget, budget_ms: 1, lod: optimise, first_appearance: " + first, true);
    int over = 0, skipped = 0, finer = 0;
    for (const FrameReport& report : reports) {
      ASSERT_TRUE(report.plan.lod);
      EXPECT_LE(report.plan.lod->benefit, report.plan.lod->upper_bound);
      EXPECT_LE(planned_drawing_ms(report), report.plan.lod->cost_ms + 1e-9);
      if (report.plan.lod->fits) {
        EXPECT_LE(planned_drawing_ms(report), 1 + 1e-9) << report.frame;
      }
      over += !report.plan.lod->fits;
      skipped += report.plan.lod->skipped;
      for (const regulator::LayerDecision& decision : report.plan.decisions)
        finer += decision.action == Action::Rerender && decision.reason.rfind("benefit", 0) == 0;
    }
    EXPECT_EQ(skipped > 0, first == "skip");
    EXPECT_LT(over, 3);
    EXPECT_GT(finer, 10) << "what was drawn coarse is refined when there is time";
  }
}

TEST(Levels, ThatNoBudgetAffordsAreCountedAndDrawnCoarsest) {
  const auto reports = played("policy: budget, budget_ms: 0.001, lod: optimise");
  EXPECT_FALSE(reports[0].plan.lod->fits);
  for (const regulator::LayerDecision& decision : reports[0].plan.decisions)
    if (decision.action == Action::Rerender) {
      EXPECT_EQ(decision.level, levels_of_a_ball() - 1);
      EXPECT_THAT(decision.reason, HasSubstr("overdraws budget"));
    }
  for (const FrameReport& report :
       played("policy: budget, budget_ms: 0, lod: optimise, first_appearance: skip")) {
    EXPECT_TRUE(report.plan.lod->fits);
    EXPECT_EQ(planned_drawing_ms(report), 0);
  }
}

TEST(Levels, FirstAppearancesAreDrawnFinestWhereThatIsAsked) {
  const auto reports = played("policy: budget, budget_ms: 1, lod: optimise, first_appearance: draw");
  for (const regulator::LayerDecision& decision : reports[0].plan.decisions)
    if (decision.action == Action::Rerender) {
      EXPECT_EQ(decision.level, 0);
    }
  EXPECT_GT(planned_drawing_ms(reports[0]), 1);
}

TEST(Levels, FeedbackFollowsTheModelledTime) {
  const auto reports = played("policy: reference, lod: feedback, budget_ms: 2, px_per_polygon: 1024");
  double late = 0;
  for (const FrameReport& report : reports)
    if (report.frame > 24) late = std::max(late, planned_drawing_ms(report));
  EXPECT_GT(late, 0.5);
  EXPECT_LT(planned_drawing_ms(reports[0]), late) << "it begins coarse, and refines";
}

/// Each selector: planned alone, or drawn, it is the same run.
TEST(Levels, APlanIsTheRun) {
  for (const std::string regulator :
       {"policy: threshold, lod: static, px_per_polygon: 4", "policy: reference, lod: feedback, budget_ms: 2",
        "policy: budget, budget_ms: 1, lod: optimise",
        "policy: budget, budget_ms: 1, lod: optimise, lod_benefit: printed",
        "policy: budget, budget_ms: 1, lod: static"}) {
    const auto planned = played(regulator), drawn = played(regulator, true);
    for (std::size_t f = 0; f < planned.size(); ++f)
      EXPECT_EQ(decisions_of(planned[f]), decisions_of(drawn[f]));
  }
}

/// A copy of a run goes on as the run does.
TEST(Levels, ACopyOfTheStateGoesOnAlike) {
  const Sequence sequence = sequence_with("policy: reference, lod: feedback, budget_ms: 2");
  Playback run(sequence, settings_of_run(sequence));
  run.all(10);
  PipelineState copy = run.state;
  const auto rest = run.all(20);
  for (int frame = 10; frame < 20; ++frame) {
    const FrameReport report = step(run.pipeline, copy, frame, nullptr);
    EXPECT_EQ(decisions_of(report), decisions_of(rest[static_cast<std::size_t>(frame - 10)]));
  }
}

}  // namespace
}  // namespace talisman::sequences
