// SPDX-License-Identifier: Apache-2.0
// Sprite compression and motion blur through the whole pipeline: what must hold whatever the scene.
#include <cmath>

#include <gtest/gtest.h>

#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/motion_blur.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/summary.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;

constexpr int kDrawnFrames = 16;

/// moving_scene: a ground at rest, a cube that spins, a moon that orbits, seen by a moving camera.
struct Film {
  layers::Scene scene = tests::moving_scene();
  layers::LayerSet layers = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings;

  explicit Film(Policy policy, double geometric_px = 4) {
    settings.regulator.policy = policy;
    settings.regulator.thresholds.geometric_px = geometric_px;
    settings.view.display_px = {200, 150};
    settings.frames = kDrawnFrames;
  }
  Film& blurred(double shutter) {
    for (layers::Layer& layer : layers.layers) layer.preferences.motion_blur = shutter;
    return *this;
  }
  Film& compressed(int quality) {
    settings.compression = chunker::CompressionOptions{quality};
    return *this;
  }
  std::vector<FrameReport> reports() const {
    const Pipeline pipeline = make_pipeline(scene, layers, settings);
    const chunker::PreparedScene prepared(scene);
    PipelineState state(pipeline);
    std::vector<FrameReport> all;
    for (int frame = 0; frame < kDrawnFrames; ++frame) all.push_back(step(pipeline, state, frame, &prepared));
    return all;
  }
};

std::vector<std::string> hashes(const std::vector<FrameReport>& reports) {
  std::vector<std::string> all;
  for (const FrameReport& report : reports) all.push_back(hash_of(report.picture));
  return all;
}

int largest_difference(const chunker::Frame& a, const chunker::Frame& b) {
  const auto x = chunker::srgb_bytes(a), y = chunker::srgb_bytes(b);
  int largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

TEST(SpriteCompressionInARun, NothingOfItExistsUnlessItIsAskedFor) {
  const Film run(Policy::Threshold);
  for (const FrameReport& report : run.reports()) EXPECT_FALSE(report.compression);
  const Pipeline pipeline = make_pipeline(run.scene, run.layers, run.settings);
  const Summary summary = start_summary(pipeline, "test");
  const auto& entry = summary.effects.at(static_cast<std::size_t>(layers::Effect::SpriteCompression));
  EXPECT_EQ(layers::name(entry.effect), "sprite_compression");
  EXPECT_FALSE(entry.called);
}

TEST(SpriteCompressionInARun, ShowsNearlyTheSameAndDecidesTheSame) {
  const auto plain = Film(Policy::Threshold).reports(),
             packed = Film(Policy::Threshold).compressed(95).reports();
  for (int f = 0; f < kDrawnFrames; ++f) {
    EXPECT_LE(largest_difference(plain[f].picture, packed[f].picture), 24) << f;
    ASSERT_EQ(plain[f].plan.decisions.size(), packed[f].plan.decisions.size());
    for (std::size_t i = 0; i < plain[f].plan.decisions.size(); ++i)
      EXPECT_EQ(plain[f].plan.decisions[i].reason, packed[f].plan.decisions[i].reason) << f;
  }
  EXPECT_NE(hashes(plain), hashes(packed)) << "what is shown has been through the compression";
}

TEST(SpriteCompressionInARun, CountersAddUp) {
  std::int64_t bytes = 0, sprites = 0;
  for (const FrameReport& report : Film(Policy::Reference).compressed(80).reports()) {
    ASSERT_TRUE(report.compression);
    const CompressionReport& c = *report.compression;
    sprites += c.sprites;
    EXPECT_EQ(c.compressed_bytes, report.sprite_bytes) << "reference: the store holds this frame's sprites";
    EXPECT_GT(c.ratio(), 3);
    EXPECT_GT(c.error.color_psnr_db(), 40);
    EXPECT_EQ(c.error.alpha_squared, 0);
    EXPECT_GT(c.cache.misses, 0);
    EXPECT_LE(c.cache.bytes_read, c.compressed_bytes * c.cache.misses);
    bytes += c.compressed_bytes;
  }
  EXPECT_EQ(sprites, 3 * kDrawnFrames);
  EXPECT_GT(bytes, 0);
}

TEST(MotionBlur, ThresholdZeroEqualsReferenceByteForByte) {
  EXPECT_EQ(hashes(Film(Policy::Threshold, 0).blurred(0.8).reports()),
            hashes(Film(Policy::Reference).blurred(0.8).reports()));
}

TEST(MotionBlur, FasterLayersAreSampledLessDenselyAndNeverBelowASixteenth) {
  Film slow(Policy::Reference), fast(Policy::Reference);
  slow.blurred(0.1);
  fast.blurred(1);
  fast.settings.fps = slow.settings.fps = 4;  // long frames: fast motion
  const Pipeline a = make_pipeline(slow.scene, slow.layers, slow.settings),
                 b = make_pipeline(fast.scene, fast.layers, fast.settings);
  PipelineState state(a);
  bool some_blur = false;
  for (const layers::LayerState& now : captured_states(a, state, 3)) {
    const MotionSampling little = motion_sampling(a, a.authored, now),
                         much = motion_sampling(b, b.authored, now);
    EXPECT_LE(much.density, little.density);
    EXPECT_GE(much.density, 1.0 / 16);
    some_blur = some_blur || much.density < 0.5;
  }
  EXPECT_TRUE(some_blur);
}

TEST(MotionBlur, AtRestThereIsNone) {
  layers::Scene scene = tests::cube_scene();
  layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  set.layers[0].preferences.motion_blur = 1;
  Settings settings;
  const Pipeline pipeline = make_pipeline(scene, set, settings);
  PipelineState state(pipeline);
  EXPECT_EQ(motion_sampling(pipeline, state.layers, captured_states(pipeline, state, 0)[0]).density, 1);
}

TEST(MotionBlur, BlurThatIsNotThatOfNowCountsAsSampling) {
  Film run(Policy::Threshold);
  run.blurred(1);
  run.settings.fps = 4;
  const Pipeline pipeline = make_pipeline(run.scene, run.layers, run.settings);
  PipelineState state(pipeline);
  bool some_differ = false;
  for (int layer = 0; layer < 3; ++layer)
    for (int frame = 0; frame < 8; ++frame) {
      const layers::LayerState& then = captured_states(pipeline, state, frame)[layer];
      const layers::LayerState& now = captured_states(pipeline, state, frame + 4)[layer];
      const double ratio = motion_sampling(pipeline, state.layers, now).density /
                           motion_sampling(pipeline, state.layers, then).density;
      regulator::LayerAssessment other, same;
      same.identical = other.identical = true;
      judge_motion_blur(pipeline, state.layers, then, now, other);
      EXPECT_EQ(other.fiducials.sampling.magnification, std::max(1.0, ratio));
      EXPECT_EQ(other.fiducials.sampling.minification, std::min(1.0, ratio));
      EXPECT_TRUE(ratio == 1 || !other.identical);
      some_differ = some_differ || ratio != 1;
      judge_motion_blur(pipeline, state.layers, then, then, same);
      EXPECT_TRUE(same.identical);
      EXPECT_EQ(same.fiducials.sampling.magnification, 1);
    }
  EXPECT_TRUE(some_differ);
}

}  // namespace
}  // namespace talisman::sequences
