// SPDX-License-Identifier: Apache-2.0
// What the decision side computes of one layer, apart from a run.
#include "sequences/pipeline/layer_planning.h"

#include <gtest/gtest.h>

#include "regulator/policies.h"
#include "sequences/pipeline/draw_instant.h"
#include "sequences/pipeline/kept_frames.h"
#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

/// moving_scene, ready to plan.
struct Planning {
  layers::Scene scene = tests::moving_scene();
  layers::LayerSet layers = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings;
  Planning() {
    settings.view.display_px = {200, 150};
    settings.frames = 48;
  }
};

constexpr int kCube = 1;

TEST(AssessSprite, EmptySpriteIsNeverGoodEnoughForWhatIsInViewNow) {
  // Its points match well, so without the rule the optimiser would show nothing at no error.
  const Planning p;
  const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
  PipelineState state(pipeline);
  const layers::LayerState& then = captured_states(pipeline, state, 3)[kCube];
  const layers::LayerState& now = captured_states(pipeline, state, 4)[kCube];
  regulator::RegulatorOptions lenient;
  lenient.thresholds.geometric_px = 1e6;
  const auto violation = [&](const layers::SpritePlacement& placement, const layers::LayerState& shown) {
    return regulator::violation_of(assess_sprite(pipeline, state.layers, then, placement, shown, 1), lenient);
  };
  EXPECT_EQ(violation(captured_placement(pipeline, state, kCube, 3), now), "");
  EXPECT_EQ(violation({}, now), "matched points 0 < 3");
  EXPECT_EQ(violation({}, then), "") << "what would be drawn identically, empty or not, is spared";
}

TEST(StatesAt, AreCapturedOnceAndForgottenWhenTheirFrameIsPast) {
  Planning p;
  p.settings.regulator.policy = regulator::Policy::Lookahead;  // keeps what is ahead
  const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
  PipelineState state(pipeline);
  begin_frame(pipeline, state, 2);
  const layers::LayerState* first = captured_states(pipeline, state, 7).data();
  captured_states(pipeline, state, 2);
  EXPECT_EQ(captured_states(pipeline, state, 7).data(), first);
  begin_frame(pipeline, state, 7);
  EXPECT_EQ(state.captured.size(), 1u);
  EXPECT_EQ(captured_states(pipeline, state, 7).data(), first);
}

TEST(StatesAt, ARunKeepsFewFramesInMemoryUnlessItLooksAhead) {
  Planning p;
  for (const auto policy : {regulator::Policy::Threshold, regulator::Policy::Budget}) {
    p.settings.regulator.policy = policy;
    const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
    PipelineState state(pipeline);
    for (int frame = 0; frame < 20; ++frame) {
      step(pipeline, state, frame, nullptr);
      EXPECT_LE(state.captured.size(), 2u) << frame;
    }
  }
}

TEST(StatesAt, AreKeptAsFarAsIsLookedAheadHoweverLongTheSequenceIs) {
  Planning p;
  p.settings.frames = 100'000;
  p.settings.regulator.policy = regulator::Policy::Lookahead;
  p.settings.regulator.lookahead.frames = 4;
  // One sprite serves as long as it is looked at.
  regulator::Thresholds& thresholds = p.settings.regulator.thresholds;
  thresholds.geometric_px = 1e6;
  thresholds.magnification = thresholds.minification = thresholds.anisotropy = thresholds.photometric = 0;
  thresholds.uncovered_px = -1;
  const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
  PipelineState state(pipeline);
  const std::size_t most = most_frames_kept(p.settings.regulator, p.settings.frames);
  EXPECT_EQ(most, 255u) << "now, four instants, and 250 frames that the last of them may serve";
  for (int frame = 0; frame < 3; ++frame) {
    begin_frame(pipeline, state, frame);
    const regulator::FrameRun run = choose_draw_instant(pipeline, state, kCube, frame);
    EXPECT_EQ(run.last, frame + 4 + kFarthestLook_frames);
    EXPECT_TRUE(looks_no_farther(pipeline, frame, run));
    EXPECT_LE(state.captured.size() + state.forgotten.size(), most + 1);
  }
  EXPECT_EQ(most_frames_kept(p.settings.regulator, 48), 48);
  p.settings.regulator.policy = regulator::Policy::Oracle;
  EXPECT_EQ(most_frames_kept(p.settings.regulator, 100'000), 100'000) << "any of them may be asked for again";
}

TEST(BytesOf, AKeptFrameAreThoseOfItsLists) {
  Planning p;
  const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
  PipelineState state(pipeline);
  CapturedFrame frame;
  const auto empty = bytes_of(frame);
  EXPECT_EQ(empty, static_cast<std::int64_t>(sizeof frame));
  frame.states.resize(2);
  frame.states[1].clip_points.resize(3);
  frame.states[1].traces.resize(1);
  frame.states[1].traces[0].places.resize(5);
  EXPECT_EQ(bytes_of(frame) - empty,
            static_cast<std::int64_t>(2 * sizeof(layers::LayerState) + 3 * sizeof(layers::dvec4) +
                                      sizeof(layers::ShadeTrace) + 5 * sizeof(layers::dvec3)));
  captured_states(pipeline, state, 3);
  EXPECT_GT(bytes_of(state.captured.at(3)), empty);
}

TEST(PlacementAt, IsTheSameWhenAskedAgain) {
  const Planning p;
  const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
  PipelineState once(pipeline), again(pipeline);
  const layers::SpritePlacement before = captured_placement(pipeline, once, kCube, 5);
  captured_placement(pipeline, again, kCube, 9);
  EXPECT_EQ(captured_placement(pipeline, again, kCube, 5), before);
  EXPECT_EQ(captured_placement(pipeline, once, kCube, 5), before);
  EXPECT_FALSE(before.empty());
}

TEST(ChooseDrawInstant, LiesInTheWindowAndTheOracleIsNeverShorter) {
  Planning p;
  p.settings.regulator.thresholds.geometric_px = 1;
  for (int frame = 0; frame < 40; frame += 3) {
    int before = 0;
    for (const int lookahead : {0, 2, 8, 32}) {
      p.settings.regulator.policy = regulator::Policy::Lookahead;
      p.settings.regulator.lookahead.frames = lookahead;
      const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
      PipelineState state(pipeline);
      const regulator::FrameRun run = choose_draw_instant(pipeline, state, kCube, frame);
      EXPECT_EQ(run.first, frame);
      EXPECT_GE(run.instant, frame);
      EXPECT_LE(run.instant, std::min(frame + lookahead, 47));
      EXPECT_GE(run.frames(), before) << "more instants to choose from";
      before = run.frames();
    }
    p.settings.regulator.policy = regulator::Policy::Oracle;
    const Pipeline pipeline = make_pipeline(p.scene, p.layers, p.settings);
    PipelineState state(pipeline);
    EXPECT_GE(choose_draw_instant(pipeline, state, kCube, frame).frames(), before);
  }
}

}  // namespace
}  // namespace talisman::sequences
