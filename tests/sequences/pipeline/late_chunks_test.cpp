// SPDX-License-Identifier: Apache-2.0
// Late chunks show the pictures of sprites that are drawn at once, decide the same, and draw less.
#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/fleet.h"
#include "tests/support/random_scene.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;

struct LatePlayback {
  std::vector<std::string> hashes;     ///< of the frames that were drawn
  std::vector<std::string> decisions;  ///< of all
  std::int64_t filled = 0, late = 0;
};

/// Every `every`-th frame is drawn, the others are planned.
LatePlayback play_late(const layers::Scene& scene, const layers::LayerSet& layers, Settings settings,
                       bool late_chunks, int every = 1) {
  settings.late_chunks = late_chunks;
  const Pipeline pipeline = make_pipeline(scene, layers, settings);
  const chunker::PreparedScene prepared(scene, settings.render);
  PipelineState state(pipeline);
  LatePlayback played;
  for (int frame = 0; frame < settings.frames; ++frame) {
    const bool draw = frame % every == every - 1;
    const FrameReport report = step(pipeline, state, frame, draw ? &prepared : nullptr);
    if (draw) played.hashes.push_back(hash_of(report.picture));
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      played.decisions.push_back(json_of(report, decision));
    played.filled += report.render.pixels_filled;
    played.late += report.late_chunks.pixels_filled;
  }
  return played;
}

LatePlayback expect_same_frames(const layers::Scene& scene, const layers::LayerSet& layers,
                                const Settings& settings, int every = 1) {
  const LatePlayback off = play_late(scene, layers, settings, false, every);
  LatePlayback on = play_late(scene, layers, settings, true, every);
  EXPECT_EQ(on.hashes, off.hashes);
  EXPECT_EQ(on.decisions, off.decisions);
  EXPECT_LE(on.filled, off.filled);
  EXPECT_EQ(off.late, 0);
  if (every == 1) {
    EXPECT_LE(on.filled + on.late, off.filled) << "a chunk was drawn twice";
  }
  return on;
}

TEST(LateChunksInFrames, EveryPolicyShowsTheSameFrames) {
  SmallRun small(tests::fleet_scene(12, 7));
  small.settings.frames = 24;
  small.settings.regulator.thresholds.geometric_px = 2;
  small.settings.regulator.budget.pixels = 20'000;
  small.lookahead(6);
  for (const Policy policy : {Policy::Reference, Policy::Hold, Policy::Threshold, Policy::Budget,
                              Policy::Interpolate, Policy::Lookahead, Policy::Oracle, Policy::Direct}) {
    SCOPED_TRACE(std::string(regulator::name(policy)));
    small.settings.regulator.policy = policy;
    for (const int every : {1, 5}) expect_same_frames(small.scene, small.layers, small.settings, every);
  }
}

TEST(LateChunksInFrames, ChunksComeIntoViewAfterTheirSpriteWasDrawn) {
  // A ball goes round in front of a wide ground and uncovers what was behind it.
  SmallRun small(tests::moving_scene());
  small.settings.view.display_px = {640, 480};
  small.settings.frames = 40;
  small.policy(Policy::Threshold, 40);
  const LatePlayback played = expect_same_frames(small.scene, small.layers, small.settings);
  EXPECT_GT(played.late, 0) << "the case says nothing unless a chunk was drawn late";
}

TEST(LateChunksInFrames, FadesCompressionAndRegistersShowTheSameFrames) {
  SmallRun small(tests::fleet_scene(9, 5));
  small.settings.frames = 20;
  small.policy(Policy::Threshold, 4);
  Settings blended = small.settings, compressed = small.settings, extended = small.settings,
           kept = small.settings, samples = small.settings;
  blended.regulator.blend_frames = 3;
  compressed.compression = chunker::CompressionOptions{85};
  extended.compositor = Compositor::Extended;
  kept.cycles = Cycles::Keep;
  samples.render.samples = 4;
  for (const Settings& settings : {blended, compressed, extended, kept, samples})
    for (const int every : {1, 4}) expect_same_frames(small.scene, small.layers, settings, every);
}

TEST(LateChunksInFrames, ScenesDrawnByLotShowTheSameFrames) {
  // Mirrors, shadow maps, shade layers, open shutters, fades, merged layers.
  const tests::TemporaryFolder folder;
  tests::write_checker(folder.path());
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Variant variant = tests::run_of(tests::random_sequence(seed, folder.path()));
    expect_same_frames(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  }
}

TEST(LateChunksInFrames, EveryEffectShowsTheSameFrames) {
  Variant variant = tests::every_effect(8);
  variant.settings.compression.reset();
  expect_same_frames(*variant.sequence.scene, variant.sequence.layers, variant.settings);
}

}  // namespace
}  // namespace talisman::sequences
