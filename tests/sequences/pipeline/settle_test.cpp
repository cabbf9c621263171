// SPDX-License-Identifier: Apache-2.0
// regulator.settle_frames end to end: a camera comes nearer, stops, comes nearer again, stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/playback.h"
#include "tests/support/scenes.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kApproachFrames = 72;
/// The last frames in which it moves, at 24 per second.
constexpr int kFirstStop = 12, kSecondStop = 48;

/// A square that faces the camera: an affine warp follows it without error. From 3 m to 2.5 m it grows by 1.2, and
/// by 1.111 to 2.25 m: never beyond the thresholds.
Variant approach(Policy policy, int settle_frames) {
  layers::Scene scene = tests::textured_quad_scene();
  layers::TransformTrack track;
  track.translation = {
      {0, 0.5, 1.5, 2}, {{0, 0, 3}, {0, 0, 2.5}, {0, 0, 2.5}, {0, 0, 2.25}}, layers::Interpolation::Linear};
  scene.tracks.push_back({scene.cameras[0].node, track});
  Sequence sequence = tests::resting_sequence(kApproachFrames);
  sequence.layer_specs = tests::one_layer_per_part(scene);
  sequence.layers = layers::factor(scene, sequence.layer_specs);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  Variant variant = tests::run_of(sequence);
  variant.settings.regulator.policy = policy;
  variant.settings.regulator.settle_frames = settle_frames;
  return variant;
}

std::vector<FrameReport> plan_approach(const Variant& variant) {
  return tests::Playback(variant.sequence, variant.settings).all(kApproachFrames);
}

std::vector<int> frames_drawn(const std::vector<FrameReport>& reports) {
  std::vector<int> frames;
  for (const FrameReport& report : reports)
    if (report.plan.decisions[0].action == Action::Rerender) frames.push_back(report.frame);
  return frames;
}

TEST(SettledRun, WithoutItTheSpriteStaysEnlarged) {
  const auto reports = plan_approach(approach(Policy::Threshold, 0));
  EXPECT_THAT(frames_drawn(reports), ElementsAre(0));
  EXPECT_NEAR(reports.back().assessments[0].fiducials.sampling.magnification, 3 / 2.25, 1e-6);
  EXPECT_EQ(reports.back().assessments[0].frames_at_rest, 0);  // not counted
}

TEST(SettledRun, IsDrawnOnceAfterEachStop) {
  for (const int n : {1, 4}) {
    const auto reports = plan_approach(approach(Policy::Threshold, n));
    EXPECT_THAT(frames_drawn(reports), ElementsAre(0, kFirstStop + n, kSecondStop + n)) << n;
    EXPECT_THAT(reports[kFirstStop + n].plan.decisions[0].reason, StartsWith("settled: at rest for "));
    EXPECT_EQ(reports.back().plan.decisions[0].reason, "unchanged");
  }
}

TEST(SettledRun, RestThatIsShorterThanAskedForIsNoRest) {
  EXPECT_THAT(frames_drawn(plan_approach(approach(Policy::Threshold, 30))), ElementsAre(0));
}

TEST(SettledRun, EveryPolicyThatDrawsOnDemandEndsSharp) {
  for (const Policy policy : {Policy::Threshold, Policy::Lookahead, Policy::Oracle, Policy::Budget}) {
    const auto reports = plan_approach(approach(policy, 2));
    const regulator::LayerAssessment& last = reports.back().assessments[0];
    EXPECT_LE(last.fiducials.sampling.magnification, 1.001) << regulator::name(policy);
    int settled = 0;
    for (const FrameReport& report : reports) {
      const regulator::LayerDecision& decision = report.plan.decisions[0];
      if (!decision.settled) continue;
      ++settled;
      EXPECT_EQ(decision.depicts_frame, report.frame) << regulator::name(policy);
    }
    EXPECT_LE(settled, 2) << regulator::name(policy);
  }
}

// A run that is continued plans what was kept, without a pixel: the memory of what is at rest comes back with it.
TEST(SettledRun, IsTheSameWhetherFramesAreDrawnOrOnlyPlanned) {
  const Variant variant = approach(Policy::Threshold, 4);
  tests::Playback drawn(variant.sequence, variant.settings, true),
      planned(variant.sequence, variant.settings);
  for (int frame = 0; frame < 20; ++frame) {
    const FrameReport with_pixels = drawn.next(), without = planned.next();
    EXPECT_EQ(with_pixels.plan.decisions[0].reason, without.plan.decisions[0].reason) << frame;
    if (frame != 16) continue;
    tests::Playback later(variant.sequence, variant.settings);
    for (int before = 0; before < 16; ++before) later.next();
    later.prepared.emplace(*later.sequence.scene);
    EXPECT_EQ(chunker::srgb_bytes(later.next().picture), chunker::srgb_bytes(with_pixels.picture));
  }
}

TEST(SettledRun, TheSettledPictureIsThatOfTheReference) {
  const Variant variant = approach(Policy::Threshold, 4);
  tests::Playback drawn(variant.sequence, variant.settings, true);
  const auto reports = drawn.all(18);
  const chunker::PreparedScene prepared(*variant.sequence.scene);
  EXPECT_EQ(chunker::srgb_bytes(reports[16].picture),
            chunker::srgb_bytes(draw_reference(drawn.pipeline, 16, prepared)));
  EXPECT_NE(chunker::srgb_bytes(reports[15].picture), chunker::srgb_bytes(reports[16].picture));
}

}  // namespace
}  // namespace talisman::sequences
