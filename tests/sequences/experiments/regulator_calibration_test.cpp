// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/calibration.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/step.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

Settings settings_for(const Sequence& sequence) {
  Settings settings;
  settings.view.display_px = sequence.display_px;
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  return settings;
}

/// A grey picture, covered wherever `covered` says so.
template <typename Value, typename Covered>
LayerPicture picture(int width, int height, Value value, Covered covered) {
  LayerPicture p{width, height, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      p.rgb.insert(p.rgb.end(), 3, static_cast<float>(value(x, y)));
      p.covered.push_back(covered(x, y));
    }
  return p;
}

constexpr auto kEverywhere = [](int, int) { return true; };

TEST(DifferenceOf, ErrorIsTheRmsOverWhatEitherPictureCovers) {
  // Half of the width is covered, by one picture or the other; they differ by 8 there and by 100 elsewhere.
  const auto left = [](int x, int) { return x < 3; };
  const auto middle = [](int x, int) { return x >= 2 && x < 5; };
  const LayerPicture old_one = picture(
      10, 6, [](int x, int) { return x < 5 ? 58 : 150; }, left);
  const LayerPicture fresh = picture(
      10, 6, [](int, int) { return 50; }, middle);
  const LayerDifference difference = difference_of(old_one, fresh);
  EXPECT_EQ(difference.pixels, 30);
  EXPECT_DOUBLE_EQ(difference.error, 8);
}

TEST(DifferenceOf, NothingCoveredIsNoError) {
  const auto nowhere = [](int, int) { return false; };
  const LayerPicture a = picture(
      4, 4, [](int, int) { return 0; }, nowhere);
  const LayerPicture b = picture(
      4, 4, [](int, int) { return 255; }, nowhere);
  EXPECT_EQ(difference_of(a, b).pixels, 0);
  EXPECT_EQ(difference_of(a, b).error, 0);
  EXPECT_TRUE(std::isnan(difference_of(a, b).apparent_shift_px));
}

TEST(DifferenceOf, ApparentShiftOfAnIsotropicTextureIsTheShift) {
  // Waves along both axes, 64 px long: a shift of 1 px either way changes half of the gradient's square.
  const auto waves = [](double dx, double dy) {
    return [=](int x, int y) {
      return 128 + 50 * std::sin((x + dx) * 2 * M_PI / 64) + 50 * std::sin((y + dy) * 2 * M_PI / 64);
    };
  };
  const LayerPicture fresh = picture(130, 130, waves(0, 0), kEverywhere);
  for (const auto& [dx, dy] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.6, 0.8}, {2.0, 0.0}})
    EXPECT_NEAR(difference_of(picture(130, 130, waves(dx, dy), kEverywhere), fresh).apparent_shift_px,
                std::hypot(dx, dy), 0.03)
        << dx << " " << dy;
}

TEST(DifferenceOf, ApparentShiftDoesNotDependOnContrastButTheErrorDoes) {
  const auto ramp = [](double slope, double shift) {
    return [=](int x, int y) { return slope * (x + y + shift); };
  };
  const LayerDifference soft =
      difference_of(picture(20, 20, ramp(0.5, 1), kEverywhere), picture(20, 20, ramp(0.5, 0), kEverywhere));
  const LayerDifference hard =
      difference_of(picture(20, 20, ramp(4, 1), kEverywhere), picture(20, 20, ramp(4, 0), kEverywhere));
  EXPECT_NEAR(hard.error, 8 * soft.error, 1e-6);
  EXPECT_NEAR(hard.apparent_shift_px, soft.apparent_shift_px, 1e-6);
  EXPECT_NEAR(soft.apparent_shift_px, 1, 1e-6);
}

TEST(DifferenceOf, WithoutAGradientThereIsNoShiftToSpeakOf) {
  const LayerPicture a = picture(
      9, 9, [](int, int) { return 20; }, kEverywhere);
  const LayerPicture b = picture(
      9, 9, [](int, int) { return 30; }, kEverywhere);
  EXPECT_FLOAT_EQ(difference_of(a, b).error, 10);
  EXPECT_TRUE(std::isnan(difference_of(a, b).apparent_shift_px));
}

TEST(CalibrationSamples, AtRestEveryFiducialAndEveryErrorIsZero) {
  const Sequence sequence = tests::resting_sequence(40);
  const std::vector<CalibrationSample> samples =
      calibration_samples(sequence, settings_for(sequence), std::vector{0, 3, 39}, ProgressKind::None);
  EXPECT_EQ(samples.size(), 0u + 2 + 6) << "no older sprite at frame 0, two at frame 3";
  for (const CalibrationSample& sample : samples) {
    EXPECT_EQ(sample.error, 0);
    for (const double value : sample.fiducials)
      if (!std::isnan(value)) {
        EXPECT_EQ(value, 0);
      }
  }
  for (const CalibrationSummary& summary : summarize_calibration(samples)) {
    EXPECT_FALSE(summary.error.defined) << "there is nothing to correlate";
    EXPECT_TRUE(summary.bins.empty());
  }
}

TEST(CalibrationSamples, FiducialsAreThoseThatTheRegulatorSees) {
  const Sequence sequence = tests::moving_sequence(40);
  const Settings settings = settings_for(sequence);
  const std::vector<CalibrationSample> samples =
      calibration_samples(sequence, settings, std::vector{20, 36}, ProgressKind::None);
  ASSERT_GT(samples.size(), 12u);
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  for (const CalibrationSample& sample : samples) {
    const int then = sample.frame - sample.age_frames;
    const regulator::LayerAssessment assessment =
        assess_sprite(pipeline, state.layers, captured_states(pipeline, state, then)[sample.layer],
                      captured_placement(pipeline, state, sample.layer, then),
                      captured_states(pipeline, state, sample.frame)[sample.layer], sample.age_frames);
    EXPECT_EQ(sample.fiducials[0], assessment.fiducials.geometric.px);
    EXPECT_GE(sample.error, 0);
    EXPECT_LE(sample.error, 255);
    EXPECT_GT(sample.pixels, 0);
  }
}

TEST(CalibrationSamples, OnAMovingSceneTheGeometricFiducialPredictsTheError) {
  const Sequence sequence = tests::moving_sequence(90);
  const std::vector<int> frames{33, 45, 57, 69, 81};
  const std::vector<CalibrationSummary> summaries = summarize_calibration(
      calibration_samples(sequence, settings_for(sequence), frames, ProgressKind::None));
  ASSERT_EQ(summaries.size(), calibrated_fiducials().size());
  EXPECT_STREQ(summaries[0].fiducial->name, "geometric");
  EXPECT_GT(summaries[0].error.n, 60);
  EXPECT_GT(summaries[0].error.rho, 0.5);
}

/// A sample of one layer whose geometric fiducial is `px`; the other fiducials were not computed.
CalibrationSample sample_of(int layer, double px, double error) {
  CalibrationSample sample;
  sample.layer = layer;
  sample.fiducials.assign(calibrated_fiducials().size(), NAN);
  sample.fiducials[0] = px;
  sample.error = error;
  sample.apparent_shift_px = px;
  return sample;
}

TEST(SummarizeCalibration, BinsAreOctavesAroundPowersOfTwo) {
  std::vector<CalibrationSample> samples;
  for (int i = 0; i < 9; ++i) samples.push_back(sample_of(0, 0.75 + 0.05 * i, 10 + i));  // around 1
  for (int i = 0; i < 8; ++i) samples.push_back(sample_of(0, 4, 30));
  for (int i = 0; i < 7; ++i) samples.push_back(sample_of(0, 32, 50));  // too few for a median
  const CalibrationSummary summary = summarize_calibration(samples).front();
  ASSERT_EQ(summary.bins.size(), 2u);
  EXPECT_EQ(summary.bins[0].center, 1);
  EXPECT_EQ(summary.bins[0].samples, 9);
  EXPECT_EQ(summary.bins[0].median_error, 14);
  EXPECT_EQ(summary.bins[0].lower_error, 12);
  EXPECT_EQ(summary.bins[0].upper_error, 16);
  EXPECT_NEAR(summary.bins[0].psnr_db(), 20 * std::log10(255.0 / 14), 1e-12);
  EXPECT_EQ(summary.bins[1].center, 4);
  EXPECT_EQ(summary.bins[1].median_error, 30);
}

TEST(SummarizeCalibration, LayersOfDifferentContrastAreAlsoJudgedByThemselves) {
  // In each layer the error rises with the fiducial, but the layer of small fiducials has the contrast.
  std::vector<CalibrationSample> samples;
  for (int i = 1; i <= 10; ++i) {
    samples.push_back(sample_of(0, i, 100 + i));
    samples.push_back(sample_of(1, 100 + i, i));
  }
  const CalibrationSummary summary = summarize_calibration(samples).front();
  EXPECT_LT(summary.error.rho, 0);
  EXPECT_EQ(summary.layers, 2);
  EXPECT_DOUBLE_EQ(summary.median_rho_of_layers, 1);
}

TEST(SummarizeCalibration, FiducialsThatWereNeverComputedSaySo) {
  const auto summaries = summarize_calibration(std::vector{sample_of(0, 1, 2), sample_of(0, 2, 3)});
  EXPECT_EQ(summaries[0].computed, 2);
  EXPECT_DOUBLE_EQ(summaries[0].error.rho, 1);
  for (std::size_t k = 1; k < summaries.size(); ++k) {
    EXPECT_EQ(summaries[k].computed, 0);
    EXPECT_FALSE(summaries[k].error.defined);
  }
}

}  // namespace
}  // namespace talisman::sequences
