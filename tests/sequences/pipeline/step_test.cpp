// SPDX-License-Identifier: Apache-2.0
// The whole pipeline on small scenes: what must hold whatever the scene.
#include "sequences/pipeline/step.h"

#include <cmath>
#include <cstdio>

#include <oneapi/tbb/global_control.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;

std::vector<std::string> hashes_of(const std::vector<FrameReport>& reports) {
  std::vector<std::string> hashes;
  for (const FrameReport& report : reports) hashes.push_back(hash_of(report.picture));
  return hashes;
}

std::vector<std::string> decisions_of(const std::vector<FrameReport>& reports) {
  std::vector<std::string> lines;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      lines.push_back(json_of(report, decision));
  return lines;
}

constexpr int kSteps = 24;

TEST(Step, ThresholdZeroEqualsReferenceByteForByte) {
  // moving_scene has a layer at rest, one that spins and one that orbits, seen by a moving camera; the second
  // scene rests in full.
  for (const layers::Scene& scene :
       {tests::moving_scene(), tests::cube_scene(), tests::skinned_bar_scene()}) {
    const auto zero = SmallRun(scene).policy(Policy::Threshold, 0).run(kSteps, true);
    const auto reference = SmallRun(scene).policy(Policy::Reference).run(kSteps, true);
    EXPECT_EQ(hashes_of(zero), hashes_of(reference));
  }
}

TEST(Step, SceneAtRestIsRenderedOnceAtThresholdZero) {
  const auto reports = SmallRun(tests::cube_scene()).policy(Policy::Threshold, 0).run(kSteps, true);
  EXPECT_EQ(count(reports, Action::Rerender), 1);
  EXPECT_EQ(count(reports, Action::Reuse), kSteps - 1);
}

/// The policies that use the fiducials, each so tight that it renders and reuses on moving_scene.
std::vector<SmallRun> fiducial_policies() {
  std::vector<SmallRun> runs;
  for (const Policy policy : {Policy::Threshold, Policy::Budget, Policy::Lookahead, Policy::Oracle}) {
    runs.push_back(SmallRun(tests::moving_scene()).policy(policy, 2).lookahead(6));
    runs.back().settings.regulator.budget.pixels = 12'000;
    runs.back().settings.frames = kSteps;
  }
  return runs;
}

TEST(Step, PlanWithoutPixelsMakesTheSameDecisions) {
  for (const SmallRun& small : fiducial_policies()) {
    SCOPED_TRACE(std::string(regulator::name(small.settings.regulator.policy)));
    const auto planned = small.run(kSteps, false);
    const auto rendered = small.run(kSteps, true);
    EXPECT_EQ(decisions_of(planned), decisions_of(rendered));
    EXPECT_GT(count(planned, Action::Reuse), 0);
    EXPECT_GT(count(planned, Action::Rerender), static_cast<int>(small.layers.layers.size()));
  }
}

TEST(Step, SameBytesForOneTwoAndThreeThreads) {
  for (const SmallRun& small : fiducial_policies()) {
    SCOPED_TRACE(std::string(regulator::name(small.settings.regulator.policy)));
    std::vector<std::vector<std::string>> hashes;
    for (const int threads : {1, 2, 3}) {
      oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      hashes.push_back(hashes_of(small.run(8, true)));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
  }
}

TEST(Step, FrameDrawnAfterPlanningOnlyHasTheSameBytes) {
  // --frames and --resume: every frame before the last is planned, not drawn.
  for (const SmallRun& small : fiducial_policies()) {
    SCOPED_TRACE(std::string(regulator::name(small.settings.regulator.policy)));
    const auto all = small.run(kSteps, true);
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    const chunker::PreparedScene prepared(small.scene);
    PipelineState state(pipeline);
    int late_renders = 0;
    for (int frame = 0; frame < kSteps; ++frame) {
      const bool draw = frame % 5 == 4 || frame == kSteps - 1;
      const FrameReport report = step(pipeline, state, frame, draw ? &prepared : nullptr);
      late_renders += report.late_renders;
      if (draw) {
        EXPECT_EQ(hash_of(report.picture), hash_of(all[frame].picture)) << frame;
      }
    }
    EXPECT_GT(late_renders, 0) << "the case says nothing unless an old sprite had to be drawn late";
  }
}

TEST(Step, DisplayedErrorNeverExceedsTheThreshold) {
  for (const double px : {0.25, 1.0, 4.0})
    for (const FrameReport& report :
         SmallRun(tests::moving_scene()).policy(Policy::Threshold, px).run(60, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) EXPECT_LE(d.shown_geometric_px, px);
}

// Their pictures may differ at the display's edge, by less than uncovered_px: their sprites grow for runs of other
// lengths.
TEST(StepLookahead, WithoutLookaheadDecidesAsThreshold) {
  const auto threshold = SmallRun(tests::moving_scene()).policy(Policy::Threshold, 2).run(kSteps, true);
  const auto none =
      SmallRun(tests::moving_scene()).policy(Policy::Lookahead, 2).lookahead(0).run(kSteps, true);
  ASSERT_EQ(none.size(), threshold.size());
  for (std::size_t frame = 0; frame < none.size(); ++frame)
    for (std::size_t layer = 0; layer < none[frame].plan.decisions.size(); ++layer) {
      const regulator::LayerDecision &ours = none[frame].plan.decisions[layer],
                                     &theirs = threshold[frame].plan.decisions[layer];
      EXPECT_EQ(ours.action, theirs.action) << "frame " << frame << ", layer " << layer;
      EXPECT_EQ(ours.shown_geometric_px, theirs.shown_geometric_px)
          << "frame " << frame << ", layer " << layer;
      EXPECT_EQ(ours.shown_warp.now_from_then, theirs.shown_warp.now_from_then);
    }
}

TEST(StepLookahead, ThresholdZeroEqualsReferenceByteForByte) {
  // Only what is identical is reused, so no instant but the frame's own can be chosen for what moves.
  for (const Policy policy : {Policy::Lookahead, Policy::Oracle})
    EXPECT_EQ(hashes_of(SmallRun(tests::moving_scene()).policy(policy, 0).run(8, true)),
              hashes_of(SmallRun(tests::moving_scene()).policy(Policy::Reference).run(8, true)));
}

TEST(StepLookahead, DisplayedErrorNeverExceedsTheThreshold) {
  // Also in the frame in which a sprite is drawn: it is drawn as of another instant and warped at once.
  for (const Policy policy : {Policy::Lookahead, Policy::Oracle})
    for (const double px : {0.25, 1.0, 4.0}) {
      int fresh_but_warped = 0;
      for (const FrameReport& report : SmallRun(tests::moving_scene()).policy(policy, px).run(60, false))
        for (const regulator::LayerDecision& d : report.plan.decisions) {
          EXPECT_LE(d.shown_geometric_px, px);
          fresh_but_warped += d.action == Action::Rerender && d.shown_geometric_px > 0;
        }
      EXPECT_GT(fresh_but_warped, 0) << "no sprite was drawn as of another instant";
    }
}

TEST(StepLookahead, NeedsFewerRendersThanThresholdAndTheOracleFewest) {
  constexpr int kLong = 96;
  for (const double px : {0.25, 1.0, 4.0}) {
    const auto renders = [px](Policy policy, int lookahead) {
      const SmallRun small = SmallRun(tests::moving_scene()).policy(policy, px).lookahead(lookahead);
      return count(small.run(kLong, false), Action::Rerender);
    };
    const int threshold = renders(Policy::Threshold, 0), oracle = renders(Policy::Oracle, 0);
    EXPECT_LT(oracle, threshold) << px;
    for (const int lookahead : {2, 8, 32}) {
      EXPECT_LT(renders(Policy::Lookahead, lookahead), threshold) << px << " px, " << lookahead << " frames";
      EXPECT_GE(renders(Policy::Lookahead, lookahead), oracle) << px << " px, " << lookahead << " frames";
    }
  }
}

TEST(StepLookahead, PromisedRunsComeTrue) {
  // "rendered as of frame 7, serves 3-11": the layer is drawn again at 12, not before and not later.
  for (const Policy policy : {Policy::Lookahead, Policy::Oracle}) {
    const auto reports = SmallRun(tests::moving_scene()).policy(policy, 1).lookahead(8).run(60, false);
    for (std::size_t layer = 0; layer < reports[0].plan.decisions.size(); ++layer) {
      int next_render = 0;
      for (const FrameReport& report : reports) {
        const regulator::LayerDecision& d = report.plan.decisions[layer];
        EXPECT_EQ(d.action == Action::Rerender, report.frame == next_render) << report.frame;
        if (d.action != Action::Rerender) continue;
        int instant = -1, first = -1, last = -1;
        const std::size_t promise = d.reason.find("rendered as of frame");
        ASSERT_NE(promise, std::string::npos) << d.reason;
        ASSERT_EQ(std::sscanf(d.reason.c_str() + promise, "rendered as of frame %d, serves %d-%d", &instant,
                              &first, &last),
                  3);
        EXPECT_EQ(d.depicts_frame, instant);
        EXPECT_EQ(first, report.frame);
        next_render = last + 1;
      }
      EXPECT_EQ(next_render, 60);
    }
  }
}

TEST(StepLookahead, AgeCountsFromTheFrameInWhichTheWorkWasDone) {
  const auto reports =
      SmallRun(tests::moving_scene()).policy(Policy::Lookahead, 4).lookahead(8).run(30, false);
  std::vector<int> rendered(reports[0].plan.decisions.size(), -1);
  for (const FrameReport& report : reports) {
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      if (d.action == Action::Reuse) {
        EXPECT_EQ(report.assessments[d.layer].frames_since_render, report.frame - rendered[d.layer]);
      }
      if (d.action == Action::Rerender) rendered[d.layer] = report.frame;
    }
    for (const ShownSprite& sprite : report.shown)
      EXPECT_EQ(sprite.age_frames, report.frame - rendered[sprite.layer]);
  }
}

TEST(StepLookahead, MinimumRateIsKeptWhereADrawingWouldChangeAnything) {
  // A threshold that never is exceeded: only the rate draws again. The frame whose instant the sprite depicts
  // would be drawn identically and is spared.
  SmallRun small = SmallRun(tests::moving_scene()).policy(Policy::Oracle, 1e6);
  for (layers::Layer& layer : small.layers.layers) layer.preferences.min_update_rate = 0.125;
  int due = 0;
  for (const FrameReport& report : small.run(40, false))
    for (const regulator::LayerAssessment& a : report.assessments) {
      if (a.frames_since_render < 8 || a.identical) continue;
      EXPECT_EQ(report.plan.decisions[a.layer].action, Action::Rerender) << report.frame;
      ++due;
    }
  EXPECT_GT(due, 0);
}

TEST(StepBudget, NoFrameSpendsMoreThanItsBudgetExceptOnFirstAppearances) {
  for (const std::int64_t pixels : {0, 3000, 12'000}) {
    SmallRun small = SmallRun(tests::moving_scene()).policy(Policy::Budget);
    small.settings.regulator.budget.pixels = pixels;
    int deferred = 0, within = 0;
    for (const FrameReport& report : small.run(40, false)) {
      std::int64_t spent = 0, on_first_appearances = 0;
      for (const regulator::LayerDecision& d : report.plan.decisions) {
        spent += d.cost.pixels;
        if (!report.assessments[d.layer].has_sprite) on_first_appearances += d.cost.pixels;
        deferred += d.reason.rfind("deferred: budget", 0) == 0;
      }
      EXPECT_LE(spent, std::max(pixels, on_first_appearances)) << pixels << " frame " << report.frame;
      within += spent > 0 && spent <= pixels;
    }
    EXPECT_EQ(within > 0, pixels > 0) << pixels;
    EXPECT_GT(deferred, 0) << pixels;
  }
}

TEST(StepBudget, UnlimitedBudgetWithoutCutOffLeavesNoError) {
  SmallRun small = SmallRun(tests::moving_scene()).policy(Policy::Budget);
  small.settings.regulator.budget.cutoff_px = 0;
  for (const FrameReport& report : small.run(kSteps, false))
    for (const regulator::LayerDecision& d : report.plan.decisions) EXPECT_LT(d.shown_geometric_px, 1e-9);
}

TEST(StepBudget, MoreBudgetMeansLessError) {
  double before = HUGE_VAL;
  for (const std::int64_t pixels : {0, 3000, 60'000}) {
    SmallRun small = SmallRun(tests::moving_scene()).policy(Policy::Budget);
    small.settings.regulator.budget.pixels = pixels;
    double sum = 0;
    for (const FrameReport& report : small.run(40, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) sum += d.shown_geometric_px;
    EXPECT_LT(sum, before) << pixels;
    before = sum;
  }
}

TEST(Step, HigherThresholdsNeedFewerRenders) {
  int before = 1 << 30;
  for (const double px : {0.25, 1.0, 4.0, 16.0}) {
    const int renders =
        count(SmallRun(tests::moving_scene()).policy(Policy::Threshold, px).run(60, false), Action::Rerender);
    EXPECT_LE(renders, before) << px;
    before = renders;
  }
}

TEST(Step, CountersAddUpFromLayersToFrame) {
  for (const FrameReport& report : SmallRun(tests::moving_scene()).policy(Policy::Reference).run(4, true)) {
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
  const SmallRun small = SmallRun(tests::moving_scene()).policy(Policy::Reference);
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  const chunker::PreparedScene prepared(small.scene);
  const auto reports = small.run(4, true);
  EXPECT_EQ(hash_of(draw_reference(pipeline, 3, prepared)), hash_of(reports[3].picture));
  const auto direct = SmallRun(tests::moving_scene()).policy(Policy::Direct).run(4, true);
  EXPECT_EQ(hash_of(draw_direct(pipeline, 3, prepared)), hash_of(direct[3].picture));
}

// What a program writes that has a scene and nothing else. The layers are a temporary: the pipeline has its own.
TEST(Step, FromASceneToItsRendersInAFewLines) {
  const layers::Scene scene = tests::moving_scene();
  Settings settings;
  settings.regulator.policy = Policy::Hold;  // every third frame
  const Pipeline pipeline =
      make_pipeline(scene, layers::factor(scene, layers::default_layer_specs(scene)), settings);
  PipelineState state(pipeline);
  int renders = 0;
  for (int frame = 0; frame < 10; ++frame)
    for (const regulator::LayerDecision& decision : step(pipeline, state, frame, nullptr).plan.decisions)
      renders += decision.action == Action::Rerender;
  EXPECT_EQ(renders, 4 * static_cast<int>(pipeline.authored.size()));  // in frames 0, 3, 6 and 9
}

TEST(Step, NoLayersShowTheBackground) {
  layers::Scene scene = tests::cube_scene();
  scene.background = {1, 0, 0};
  const layers::LayerSet none;
  Settings settings;
  settings.view.display_px = {5, 3};
  const Pipeline pipeline = make_pipeline(scene, none, settings);
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
    for (const FrameReport& report : SmallRun(scene).policy(Policy::Threshold, 2).run(kSteps, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) actions.push_back(d.action);
    return actions;
  };
  const auto metres = decisions(tests::moving_scene());
  EXPECT_EQ(decisions(tests::tiny_scene()), metres);
  EXPECT_EQ(decisions(tests::huge_scene()), metres);
}

}  // namespace
}  // namespace talisman::sequences
