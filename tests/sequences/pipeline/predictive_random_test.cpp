// SPDX-License-Identifier: Apache-2.0
// Scenes drawn by lot, lights and shadows that move among them: with δ = 0 and one sample every frame out of shared
// buffers is that of one pass.
#include <gtest/gtest.h>

#include "sequences/content/own_settings.h"
#include "sequences/pipeline/predictive/plan_buffers.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"

namespace talisman::sequences {
namespace {

Settings settings_of(const Sequence& sequence, regulator::Policy policy) {
  Settings settings = own_settings(sequence);
  settings.render.samples = 1;
  settings.compression.reset();
  settings.compositor = Compositor::Talisman;
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = 0;
  settings.regulator.lookahead.frames = 4;
  return settings;
}

TEST(PredictiveRandom, EveryFrameIsThatOfOnePass) {
  const tests::TemporaryFolder folder;
  int compared = 0, refused = 0, with_shadows = 0;
  std::int64_t drawn = 0, shown = 0;
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    const Sequence sequence = tests::random_sequence(seed, folder.path());
    if (!unpredictable(*sequence.scene, sequence.layers).empty()) {
      ++refused;
      continue;
    }
    ++compared;
    with_shadows += !sequence.layers.casting_parts.empty();
    const Pipeline pipeline =
        make_pipeline(*sequence.scene, sequence.layers, settings_of(sequence, regulator::Policy::Predictive));
    const Pipeline direct =
        make_pipeline(*sequence.scene, sequence.layers, settings_of(sequence, regulator::Policy::Direct));
    const chunker::PreparedScene prepared(*sequence.scene, pipeline.settings.render);
    PipelineState state(pipeline);
    for (int frame = 0; frame < sequence.frames; ++frame) {
      const FrameReport report = step(pipeline, state, frame, &prepared);
      drawn += report.predictive->parts_drawn;
      shown += report.predictive->parts;
      ASSERT_EQ(report.picture.pixels, draw_direct(direct, frame, prepared).pixels)
          << "seed " << seed << " frame " << frame;
    }
  }
  EXPECT_GE(compared, 10);
  EXPECT_GE(with_shadows, 3);
  EXPECT_GT(refused, 0);
  EXPECT_LT(drawn, shown) << "nothing rested: the case says little";
}

}  // namespace
}  // namespace talisman::sequences
