// SPDX-License-Identifier: Apache-2.0
// Policies hold and interpolate end to end: triple framing [LS97 7.2].
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;

constexpr int kPeriod = 3;

/// A ball that leaves the view after a beat, is away on two of them, and comes back between two.
constexpr const char* kGhost = R"(
name: ghost
frames: 24
fps: 24
display: [160, 120]
background: "#203040"
shapes:
  - id: ball
    sphere: 0.6
    color: "#ff4040"
    unlit: true
    flight:
      - {t: 0, position: [0, 0, 0], target: [100, 0, 0]}
      - {t: 0.166667, position: [3, 0, 0], target: [100, 0, 0]}
      - {t: 0.375, position: [9, 0, 0], target: [100, 0, 0]}
      - {t: 0.45833, position: [2.0, 1.2, 0], target: [-100, 0, 0]}
      - {t: 0.8, position: [-1, 1, 0], target: [-100, 0, 0]}
camera: {fov_deg: 40, near_m: 0.1, far_m: 60, position: [0, 0, 6], look_at: [0, 0, 0]}
layers:
  - {name: ball, parts: [ball]}
)";

/// Two slabs, of which the farther one becomes the nearer one between two beats.
constexpr const char* kSwapped = R"(
name: swapped
frames: 12
fps: 24
display: [160, 120]
background: "#203040"
shapes:
  - {id: a, box: [1.5, 1.5, 0.1], color: "#ff0000", unlit: true, flight: [
      {t: 0, position: [0.3, 0, -0.5], target: [0.3, 0, -100]},
      {t: 0.166667, position: [0.3, 0, -0.3], target: [0.3, 0, -100]},
      {t: 0.208333, position: [0.3, 0, 0.5], target: [0.3, 0, -100]},
      {t: 0.5, position: [0.3, 0, 0.6], target: [0.3, 0, -100]}]}
  - {id: b, box: [1.5, 1.5, 0.1], color: "#0000ff", unlit: true}
camera: {fov_deg: 40, near_m: 0.1, far_m: 60, position: [0, 0, 6], look_at: [0, 0, 0]}
layers:
  - {name: a, parts: [a], fade: [{t: 0, value: 1}, {t: 0.5, value: 0.2}]}
  - {name: b, parts: [b]}
)";

Variant read(const char* text) {
  const tests::TemporaryFolder folder;
  return tests::run_of(load_sequence(folder.write("case.yaml", text)));
}

std::vector<FrameReport> play(Variant variant, Policy policy, int frames, int period = kPeriod) {
  variant.settings.regulator.policy = policy;
  variant.settings.regulator.hold_frames = period;
  return tests::Playback(variant.sequence, variant.settings, true).all(frames);
}

/// The picture of a beat is that of `reference`, and under `hold` it stands until the next one.
void expect_pictures_of_beats(const Variant& variant, int frames, int period) {
  const auto reference = play(variant, Policy::Reference, frames);
  const auto held = play(variant, Policy::Hold, frames, period);
  const auto moved = play(variant, Policy::Interpolate, frames, period);
  for (int frame = 0; frame < frames; ++frame) {
    const int beat = frame - frame % period;
    EXPECT_EQ(hash_of(held[frame].picture), hash_of(reference[beat].picture)) << "hold, frame " << frame;
    if (frame == beat) {
      EXPECT_EQ(hash_of(moved[frame].picture), hash_of(reference[beat].picture)) << "interpolate " << frame;
    }
    for (const auto& reports : {held, moved})
      for (const ShownSprite& sprite : reports[frame].shown) EXPECT_LE(sprite.age_frames, frame - beat);
  }
}

TEST(PolicyHold, PictureOfABeatStandsUntilTheNextOneWhateverLeavesOrReturns) {
  expect_pictures_of_beats(read(kGhost), 24, kPeriod);
}

TEST(PolicyHold, OrderAndFadesChangeOnTheBeat) { expect_pictures_of_beats(read(kSwapped), 12, kPeriod); }

TEST(PolicyHold, MergedAndShadedLayersStandToo) {
  expect_pictures_of_beats(tests::run_of(tests::moving_sequence(12)), 12, 5);
  Variant effects = tests::every_effect(10);
  effects.settings.compression.reset();
  expect_pictures_of_beats(effects, 10, 4);
}

TEST(PolicyHold, FirstAppearanceBetweenBeatsIsSaidToWait) {
  const auto held = play(read(kGhost), Policy::Hold, 24);
  EXPECT_EQ(held[9].plan.decisions[0].action, Action::Drop);
  EXPECT_EQ(held[11].plan.decisions[0].reason, "policy: hold 3, first shown on the next beat");
  EXPECT_EQ(held[12].plan.decisions[0].action, Action::Rerender);
}

TEST(PolicyInterpolate, WarpsEveryFrameInTheOrderOfTheBeat) {
  const auto moved = play(read(kSwapped), Policy::Interpolate, 12);
  EXPECT_EQ(moved[5].order.back_to_front, moved[3].order.back_to_front);
  EXPECT_NE(moved[6].order.back_to_front, moved[3].order.back_to_front);
  for (const int frame : {4, 5}) {
    EXPECT_EQ(moved[frame].plan.decisions[0].action, Action::Reuse);
    EXPECT_FALSE(moved[frame].plan.decisions[0].shown_warp.is_identity()) << frame;
    EXPECT_EQ(moved[frame].shown[0].multipliers.alpha, moved[3].shown[0].multipliers.alpha);
  }
}

// A run may begin between two beats, skip frames, repeat them and go back: nothing older than a beat is shown.
TEST(PolicyHold, AnyFrameMayFollowAnyOther) {
  Variant variant = read(kGhost);
  variant.settings.regulator.policy = Policy::Hold;
  tests::Playback playback(variant.sequence, variant.settings, true);
  for (const int frame : {4, 5, 5, 4, 3, 2, 14, 23, 1, 11, 12, 13}) {
    const FrameReport report = step(playback.pipeline, playback.state, frame, &*playback.prepared);
    for (const ShownSprite& sprite : report.shown)
      EXPECT_LE(std::abs(frame - playback.state.memory[sprite.layer].frame_rendered), 2) << frame;
  }
}

// Between beats nothing is sorted: the frame says so.
TEST(PolicyHold, SortsOnTheBeatAlone) {
  const auto held = play(read(kSwapped), Policy::Hold, 6);
  EXPECT_TRUE(held[3].order.sorted);
  EXPECT_FALSE(held[4].order.sorted);
  EXPECT_EQ(held[4].reference.polygons, held[3].reference.polygons)
      << "reference would draw both all the same";
}

}  // namespace
}  // namespace talisman::sequences
