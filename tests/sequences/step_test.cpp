// SPDX-License-Identifier: Apache-2.0
// The whole pipeline on small scenes: what must hold whatever the scene.
#include "sequences/step.h"

#include <oneapi/tbb/global_control.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;

/// A scene with its layers, ready to run.
struct Stage {
  layers::Scene scene;
  layers::LayerSet layers;
  Settings settings;

  explicit Stage(layers::Scene scene_in) : scene(std::move(scene_in)) {
    layers = layers::factor(scene, tests::one_layer_per_part(scene));
    settings.view.display_px = {200, 150};
  }

  Stage& policy(Policy policy, double geometric_px = 4) {
    settings.regulator.policy = policy;
    settings.regulator.geometric_px = geometric_px;
    return *this;
  }

  std::vector<FrameReport> run(int frames, bool draw) const {
    const Pipeline pipeline(scene, layers, settings);
    const chunker::PreparedScene prepared(scene);
    PipelineState state(pipeline);
    std::vector<FrameReport> reports;
    for (int frame = 0; frame < frames; ++frame)
      reports.push_back(step(pipeline, state, frame, draw ? &prepared : nullptr));
    return reports;
  }
};

std::vector<std::string> hashes_of(const std::vector<FrameReport>& reports) {
  std::vector<std::string> hashes;
  for (const FrameReport& report : reports) hashes.push_back(hash_of(report.picture));
  return hashes;
}

std::vector<std::string> decisions_of(const Stage& stage, const std::vector<FrameReport>& reports) {
  const Pipeline pipeline(stage.scene, stage.layers, stage.settings);
  std::vector<std::string> lines;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      lines.push_back(json_of(pipeline, report, decision));
  return lines;
}

int count(const std::vector<FrameReport>& reports, Action action) {
  int n = 0;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions) n += decision.action == action;
  return n;
}

constexpr int kFrames = 24;

TEST(Step, ThresholdZeroEqualsReferenceByteForByte) {
  // moving_scene has a layer at rest, one that spins and one that orbits, seen by a moving camera; the second
  // scene rests in full.
  for (const layers::Scene& scene :
       {tests::moving_scene(), tests::cube_scene(), tests::skinned_bar_scene()}) {
    const auto zero = Stage(scene).policy(Policy::Threshold, 0).run(kFrames, true);
    const auto reference = Stage(scene).policy(Policy::Reference).run(kFrames, true);
    EXPECT_EQ(hashes_of(zero), hashes_of(reference));
  }
}

TEST(Step, SceneAtRestIsRenderedOnceAtThresholdZero) {
  const auto reports = Stage(tests::cube_scene()).policy(Policy::Threshold, 0).run(kFrames, true);
  EXPECT_EQ(count(reports, Action::Rerender), 1);
  EXPECT_EQ(count(reports, Action::Reuse), kFrames - 1);
}

TEST(Step, PlanWithoutPixelsMakesTheSameDecisions) {
  const Stage stage = Stage(tests::moving_scene()).policy(Policy::Threshold, 2);
  const auto planned = stage.run(kFrames, false);
  const auto rendered = stage.run(kFrames, true);
  EXPECT_EQ(decisions_of(stage, planned), decisions_of(stage, rendered));
  EXPECT_GT(count(planned, Action::Reuse), 0);
  EXPECT_GT(count(planned, Action::Rerender), static_cast<int>(stage.layers.layers.size()));
}

TEST(Step, SameBytesForOneTwoAndThreeThreads) {
  const Stage stage = Stage(tests::moving_scene()).policy(Policy::Threshold, 2);
  std::vector<std::vector<std::string>> hashes;
  for (const int threads : {1, 2, 3}) {
    oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    hashes.push_back(hashes_of(stage.run(8, true)));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Step, FrameDrawnAfterPlanningOnlyHasTheSameBytes) {
  // --frames and --resume: every frame before the last is planned, not drawn.
  const Stage stage = Stage(tests::moving_scene()).policy(Policy::Threshold, 3);
  const auto all = stage.run(kFrames, true);
  const Pipeline pipeline(stage.scene, stage.layers, stage.settings);
  const chunker::PreparedScene prepared(stage.scene);
  PipelineState state(pipeline);
  FrameReport last;
  for (int frame = 0; frame < kFrames; ++frame)
    last = step(pipeline, state, frame, frame == kFrames - 1 ? &prepared : nullptr);
  EXPECT_EQ(hash_of(last.picture), hash_of(all.back().picture));
  EXPECT_GT(last.late_renders, 0) << "the case says nothing unless an old sprite had to be drawn late";
}

TEST(Step, DisplayedErrorNeverExceedsTheThreshold) {
  for (const double px : {0.25, 1.0, 4.0})
    for (const FrameReport& report :
         Stage(tests::moving_scene()).policy(Policy::Threshold, px).run(60, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) EXPECT_LE(d.shown_geometric_px, px);
}

TEST(Step, HigherThresholdsNeedFewerRenders) {
  int before = 1 << 30;
  for (const double px : {0.25, 1.0, 4.0, 16.0}) {
    const int renders =
        count(Stage(tests::moving_scene()).policy(Policy::Threshold, px).run(60, false), Action::Rerender);
    EXPECT_LE(renders, before) << px;
    before = renders;
  }
}

TEST(Step, CountersAddUpFromLayersToFrame) {
  for (const FrameReport& report : Stage(tests::moving_scene()).policy(Policy::Reference).run(4, true)) {
    chunker::RenderCounters sum;
    for (const chunker::RenderCounters& layer : report.render_by_layer) sum += layer;
    EXPECT_EQ(sum, report.render);
    EXPECT_GT(report.render.pixels_filled, 0);
    std::int64_t chunks_planned = 0;
    for (const regulator::LayerDecision& d : report.plan.decisions) chunks_planned += d.cost.chunks;
    EXPECT_EQ(report.render.chunks_rendered + report.render.chunks_clear, chunks_planned);
  }
}

TEST(Step, DrawingTheTruthsDoesNotDisturbTheRun) {
  const Stage stage = Stage(tests::moving_scene()).policy(Policy::Reference);
  const Pipeline pipeline(stage.scene, stage.layers, stage.settings);
  const chunker::PreparedScene prepared(stage.scene);
  const auto reports = stage.run(4, true);
  EXPECT_EQ(hash_of(draw_reference(pipeline, 3, prepared)), hash_of(reports[3].picture));
  const auto direct = Stage(tests::moving_scene()).policy(Policy::Direct).run(4, true);
  EXPECT_EQ(hash_of(draw_direct(pipeline, 3, prepared)), hash_of(direct[3].picture));
}

TEST(Step, NoLayersShowTheBackground) {
  layers::Scene scene = tests::cube_scene();
  scene.background = {1, 0, 0};
  const layers::LayerSet none;
  Settings settings;
  settings.view.display_px = {5, 3};
  const Pipeline pipeline(scene, none, settings);
  const chunker::PreparedScene prepared(scene);
  PipelineState state(pipeline);
  const FrameReport report = step(pipeline, state, 0, &prepared);
  ASSERT_EQ(report.picture.pixels.size(), 15u);
  EXPECT_EQ(report.picture.pixels[7].r, chunker::kOne);
  EXPECT_EQ(report.picture.pixels[7].g, 0);
}

TEST(Step, SameDecisionsInMillimetresAndMegametres) {
  // Nothing in the decision side may depend on the unit of length.
  const auto decisions = [](const layers::Scene& scene) {
    std::vector<Action> actions;
    for (const FrameReport& report : Stage(scene).policy(Policy::Threshold, 2).run(kFrames, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) actions.push_back(d.action);
    return actions;
  };
  const auto metres = decisions(tests::moving_scene());
  EXPECT_EQ(decisions(tests::tiny_scene()), metres);
  EXPECT_EQ(decisions(tests::huge_scene()), metres);
}

}  // namespace
}  // namespace talisman::sequences
