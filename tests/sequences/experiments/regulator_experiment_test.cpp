// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/experiments/regulator/lookahead_curve.h"
#include "sequences/pictures/diff.h"
#include "sequences/pipeline/step.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;

constexpr int kMovingFrames = 24;

const Sequence& moving() {
  static const Sequence sequence = tests::moving_sequence(kMovingFrames);
  return sequence;
}

Settings settings_of(const Sequence& sequence) {
  Settings settings;
  settings.view.display_px = sequence.display_px;
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  return settings;
}

std::vector<SettingResult> measure(const std::vector<RegulatorSetting>& compared,
                                   const ExperimentFrames& frames) {
  return measure_regulator(moving(), settings_of(moving()), compared, frames, ProgressKind::None);
}

/// Every setting on every frame, measured once for all tests.
const std::vector<SettingResult>& everything() {
  static const std::vector<SettingResult> results = [] {
    const ExperimentFrames all{0, kMovingFrames - 1, 1};
    const double polygons = reference_polygons_per_frame(moving(), settings_of(moving()), all);
    return measure(regulator_settings({}, polygons), all);
  }();
  return results;
}

std::map<double, SettingResult> by_knob(const std::string& series) {
  std::map<double, SettingResult> results;
  for (const SettingResult& result : everything())
    if (result.setting.series == series) results.emplace(result.setting.value, result);
  return results;
}

// --- Which settings

TEST(RegulatorSettings, AreValidDistinctAndBeginWithTheReference) {
  regulator::RegulatorOptions base;
  // Of a sequence whose own policy is budget: must not limit the others.
  base.budget = {5, 5, 5, 0.1};
  const std::vector<RegulatorSetting> settings = regulator_settings(base, 1000);
  EXPECT_EQ(settings.front().options.policy, Policy::Reference);
  std::set<std::string> names;
  for (const RegulatorSetting& setting : settings) {
    EXPECT_EQ(regulator::first_defect(setting.options), "");
    EXPECT_EQ(setting.options.budget.pixels, regulator::kNoLimit);
    EXPECT_EQ(setting.options.budget.chunks, regulator::kNoLimit);
    EXPECT_EQ(setting.options.budget.ms, regulator::kNoLimitMs);
    names.insert(setting.series + " " + setting.knob());
  }
  EXPECT_EQ(names.size(), settings.size());
  EXPECT_EQ(settings.size(), 1u + 4 + 4 + 6 + 6 + 3 * 2 + 4 + 3 + 3 + 6 + 6 + 5 + 5);
}

TEST(RegulatorSettings, BudgetsAreSharesOfTheReference) {
  for (const RegulatorSetting& setting : regulator_settings({}, 1000)) {
    if (setting.options.policy != Policy::Budget) {
      EXPECT_EQ(setting.options.budget.polygons, regulator::kNoLimit);
      continue;
    }
    EXPECT_EQ(setting.options.budget.polygons, std::llround(10 * setting.value));
  }
}

// --- What is measured

TEST(MeasureRegulator, TheReferenceIsItsOwnTruth) {
  const SettingResult& reference = everything().front();
  EXPECT_EQ(reference.mean_update_rate, 1);
  EXPECT_EQ(reference.max_geometric_px, 0);
  EXPECT_EQ(reference.quality.psnr_db, HUGE_VAL);
  EXPECT_EQ(reference.quality.flip, 0);
  EXPECT_EQ(reference.popping.rms, 0);
  EXPECT_EQ(reference.popping.elsewhere_rms, 0);
  EXPECT_EQ(reference.popping.frames, kMovingFrames - 1);
  EXPECT_GT(reference.popping.stepping_share, 0.3) << "it draws everything again, and nothing jumps";
}

TEST(MeasureRegulator, AllOthersLoseSomethingAndEveryNumberIsFinite) {
  for (const SettingResult& r : everything()) {
    SCOPED_TRACE(r.setting.series + " " + r.setting.knob());
    if (r.setting.series == "reference") continue;
    // A series "threshold in 8" has eight layers for each.
    const std::size_t in = r.setting.series.find(" in ");
    const int pieces = in == std::string::npos ? 1 : std::stoi(r.setting.series.substr(in + 4));
    EXPECT_LT(r.renders, pieces * everything().front().renders);
    for (const double value : {r.quality.psnr_db, r.quality.ssim, r.quality.flip, r.mean_geometric_px,
                               r.max_geometric_px, r.popping.rms, r.modelled_ms, r.frame_ms()})
      EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(r.quality.flip, 0);
    EXPECT_GT(r.popping.rms, 0);
    EXPECT_LE(r.popping.rms, 255);
    EXPECT_GT(r.frame_ms(), 0);
  }
}

TEST(MeasureRegulator, ALooserThresholdDrawsLessAndKeepsItsBound) {
  std::int64_t polygons = everything().front().polygons;
  for (const auto& [px, result] : by_knob("threshold")) {
    EXPECT_LE(result.polygons, polygons) << px;
    EXPECT_LE(result.max_geometric_px, px);
    polygons = result.polygons;
  }
}

TEST(MeasureRegulator, TheOracleIsTheFloorOfItsBound) {
  const auto oracle = by_knob("oracle");
  for (const std::string series : {"threshold", "lookahead 16"})
    for (const auto& [px, result] : by_knob(series)) {
      EXPECT_LE(oracle.at(px).renders, result.renders) << series << " " << px;
      EXPECT_LE(oracle.at(px).max_geometric_px, px);
    }
}

TEST(MeasureRegulator, ALongerHoldPopsHarder) {
  // The step at the end of a hold is the motion of its frames; from 5 frames on it exceeds the squares of the
  // ground's texture, and grows no more.
  const auto hold = by_knob("hold");
  EXPECT_GT(hold.at(3).popping.rms, hold.at(2).popping.rms);
  EXPECT_GT(hold.at(5).popping.rms, hold.at(3).popping.rms);
}

/// One policy by itself, frame by frame, every truth drawn anew: what measure_regulator must find.
struct SlowRun {
  std::vector<FrameDiff> quality;
  double popping_squares = 0, popping_samples = 0;
};

SlowRun slow_run(const regulator::RegulatorOptions& options, const std::set<int>& frames) {
  Settings settings = settings_of(moving());
  settings.regulator = options;
  const Pipeline pipeline = make_pipeline(*moving().scene, moving().layers, settings);
  const chunker::PreparedScene prepared(*moving().scene);
  PipelineState state(pipeline);
  SlowRun run;
  FrameReport before;
  for (int frame = 0; frame < kMovingFrames; ++frame) {
    FrameReport now = step(pipeline, state, frame, &prepared);
    if (frames.count(frame)) {
      const Image8 shown = to_image8(now.picture),
                   truth = to_image8(draw_reference(pipeline, frame, prepared));
      run.quality.push_back({"", compare(shown, truth)});
      if (frame > 0) {
        const Image8 shown_before = to_image8(before.picture),
                     truth_before = to_image8(draw_reference(pipeline, frame - 1, prepared));
        std::vector<int> layers_before;
        for (const ShownSprite& sprite : before.shown) layers_before.push_back(sprite.layer);
        const PixelMask mask = stepping_pixels(layers_before, now, state.sprites, settings.view.display_px);
        for (std::size_t i = 0; i < shown.rgb.size(); ++i) {
          if (!mask[i / 3]) continue;
          const double d = (shown.rgb[i] - truth.rgb[i]) - (shown_before.rgb[i] - truth_before.rgb[i]);
          run.popping_squares += d * d;
          run.popping_samples += 1;
        }
      }
    }
    before = std::move(now);
  }
  return run;
}

TEST(MeasureRegulator, SamplingFramesChangesNoPictureAndNoPlan) {
  // Frames between samples are planned only; their sprites are drawn late. Each setting must come out as if
  // it had been run alone with every frame drawn.
  std::vector<RegulatorSetting> compared{everything().front().setting};
  for (const char* series : {"hold", "threshold", "lookahead 16", "oracle", "budget"})
    compared.push_back(std::next(by_knob(series).begin())->second.setting);
  for (const ExperimentFrames& frames :
       {ExperimentFrames{0, kMovingFrames - 1, 5}, ExperimentFrames{7, 18, 3}}) {
    const std::vector<int> sampled = sampled_frames(frames);
    const std::vector<SettingResult> results = measure(compared, frames);
    for (std::size_t k = 1; k < results.size(); ++k) {
      SCOPED_TRACE(compared[k].series);
      const SlowRun slow = slow_run(compared[k].options, {sampled.begin(), sampled.end()});
      const Quality quality = summarize(slow.quality).mean;
      EXPECT_EQ(results[k].quality.flip, quality.flip);
      EXPECT_EQ(results[k].quality.psnr_db, quality.psnr_db);
      if (slow.popping_samples > 0) {
        EXPECT_NEAR(results[k].popping.rms, std::sqrt(slow.popping_squares / slow.popping_samples), 1e-9);
      }
      if (frames.first > 0) continue;
      for (const SettingResult& full : everything()) {
        if (full.setting.options == compared[k].options) {
          EXPECT_EQ(results[k].polygons, full.polygons);
        }
      }
    }
  }
}

TEST(ReferencePolygonsPerFrame, AreThoseOfTheLayersInView) {
  // All three layers of the scene are in view in every frame.
  double polygons = 0;
  for (const layers::Layer& layer : moving().layers.layers) polygons += layer.polygons;
  EXPECT_DOUBLE_EQ(reference_polygons_per_frame(moving(), settings_of(moving()), {3, 9, 2}), polygons);
}

// --- Lookahead

TEST(LookaheadCurve, LiesBetweenThresholdAndOracle) {
  Settings settings = settings_of(moving());
  settings.regulator.thresholds.geometric_px = 1;
  const LookaheadCurve curve = lookahead_curve(moving(), settings, {0, kMovingFrames - 1, 1});
  const std::size_t lookaheads = compared_lookaheads().size();
  ASSERT_EQ(curve.points.size(), 2 * lookaheads) << "known and predicted";
  EXPECT_EQ(curve.points.front().frames, 0);
  EXPECT_EQ(curve.points.front().renders, curve.threshold_renders) << "N = 0 is the policy threshold";
  EXPECT_LT(curve.oracle_renders, curve.threshold_renders);
  for (const LookaheadPoint& point : curve.points) {
    EXPECT_GE(point.renders, curve.oracle_renders) << point.frames;
    EXPECT_LE(point.max_geometric_px, 1) << point.frames;
  }
  EXPECT_EQ(curve.points[lookaheads - 1].renders, curve.oracle_renders)
      << "64 frames are more than the sequence has";
}

}  // namespace
}  // namespace talisman::sequences
