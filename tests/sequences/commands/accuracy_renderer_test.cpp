// SPDX-License-Identifier: Apache-2.0
// `accuracy --renderer` from the command to its files.
#include "sequences/commands/accuracy_renderer.h"

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/accuracy.h"
#include "sequences/experiments/renderer/plots.h"
#include "sequences/experiments/renderer/sheets.h"
#include "sequences/files/image_io.h"
#include "tests/sequences/commands/experiment_files.h"
#include "tests/sequences/csv_rows.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;
using tests::rows_of;
using tests::without_times;

ExperimentOptions quick_renderer() { return tests::quick_options("0-5", "64x48"); }

/// Without shadows, whose finest maps take long.
const Sequence& shown() {
  static const Sequence sequence =
      without_effect(tests::every_effect(12), layers::Effect::ShadowMap).sequence;
  return sequence;
}

class RendererReportFiles : public testing::Test {
 protected:
  static const RendererReport& report() {
    static const RendererReport measured = measure_renderer_report(shown(), quick_renderer());
    return measured;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(RendererReportFiles, AllAreThere) {
  write_report(report(), folder_.path());
  tests::expect_files(folder_,
                      {"renderer.csv", "renderer-effects.csv", "renderer.json", "renderer-pixels.svg",
                       "renderer-pixels-work.csv", "renderer-sprites.svg", "renderer-sprites-work.svg",
                       "renderer-effects.svg", "renderer-over-time.svg", "effects.png", "knob-samples.png",
                       "knob-texture-filter.png", "knob-all-shade-layers.png", "knob-motion-blur.png"});
  EXPECT_FALSE(folder_.names().contains("knob-shadow-map.png")) << "not called for";
}

TEST_F(RendererReportFiles, CsvHasOneFullLinePerRung) {
  const auto rows = rows_of(knobs_csv(report()));
  ASSERT_EQ(rows.size(), 1 + report().knobs.rungs.size());
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), rows[0].size());
    for (std::size_t c = 2; c < rows[k].size(); ++c) {
      const std::string& name = rows[0][c];
      if (name == "work_unit") continue;
      // Of equal pictures there is no PSNR; a gain needs a rung before and times that differ.
      const bool may_be_empty =
          name.find("psnr") != std::string::npos || name.find("gain") != std::string::npos;
      if (may_be_empty && rows[k][c].empty()) continue;
      EXPECT_TRUE(!rows[k][c].empty() && std::isfinite(std::stod(rows[k][c]))) << name << " line " << k;
    }
  }
}

TEST_F(RendererReportFiles, CsvOfEffectsHasALineWithAllAndOneWithoutEach) {
  const auto rows = rows_of(effects_csv(report()));
  EXPECT_EQ(rows.size(), 1 + 2 + report().effects.pictures.size() + report().effects.over_time.size());
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows[1][0], "frames");
  EXPECT_EQ(rows[1][1], "") << "with all";
}

TEST_F(RendererReportFiles, JsonSaysWhatWasMeasuredAndWhatWasNot) {
  const nlohmann::json json = nlohmann::json::parse(json_of(report()));
  EXPECT_EQ(json["schema"], "talisman.renderer/1");
  EXPECT_EQ(json["settings_given"]["geometric_px"], report().given.regulator.thresholds.geometric_px);
  EXPECT_GT(json["settings_given"].size(), 20u);
  EXPECT_EQ(json["display_px"], (nlohmann::json{64, 48}));
  EXPECT_THAT(json["truth"].get<std::string>(), HasSubstr("16 samples"));
  EXPECT_EQ(json["knobs"].size(), report().knobs.ladder.knobs.size());
  for (const nlohmann::json& knob : json["knobs"]) {
    EXPECT_EQ(knob.contains("rungs"), knob["called"].get<bool>());
    if (!knob["called"].get<bool>()) {
      EXPECT_EQ(knob["why_not"], "no light casts shadows") << knob["knob"];
    }
  }
  EXPECT_TRUE(json["knobs"][0]["rungs"][2]["psnr_db"].is_null()) << "the truth equals itself";
  EXPECT_EQ(json["effects"]["not_called"].size(), report().effects.not_called.size());
  EXPECT_EQ(json["effects"]["over_time"]["last_frame"], 5);
}

TEST_F(RendererReportFiles, AllButTheTimesIsTheSameInEveryRun) {
  const RendererReport again = measure_renderer_report(shown(), quick_renderer());
  EXPECT_EQ(without_times(knobs_csv(again)), without_times(knobs_csv(report())));
  EXPECT_EQ(without_times(effects_csv(again)), without_times(effects_csv(report())));
}

TEST_F(RendererReportFiles, TheTableSaysWhatWasUsed) {
  tests::expect_table(tests::printed(report()),
                      {"64x48 px", "median of 3 interleaved rounds", "one pass, 16 samples",
                       "frames 0-5, policy threshold", "no light casts shadows", "anisotropy 8"});
}

TEST_F(RendererReportFiles, PlotsHaveASeriesPerKnobThatIsMeasured) {
  std::size_t called = 0;
  for (const Knob& knob : report().knobs.ladder.knobs) called += knob.called();
  EXPECT_EQ(knob_time_plot(report(), false).series.size() + knob_time_plot(report(), true).series.size(),
            called);
  for (const PlotSeries& series : knob_work_plot(report(), false).series)
    EXPECT_EQ(series.points.back().x, 100) << series.name << ": the last rung is all of it";
}

TEST_F(RendererReportFiles, ASheetShowsEveryRungAndTheTruth) {
  const Image8 one_pass = knob_sheet(report().knobs, 0);  // samples: 1, 4, 16
  EXPECT_EQ(one_pass.rgb.size(), std::size_t(one_pass.width) * one_pass.height * 3);
  EXPECT_GE(one_pass.width, 3 * 2 * 64) << "three crops of the whole picture, twice as large";
  EXPECT_GE(one_pass.height, 2 * 2 * 48) << "and their differences";
}

TEST(MeasureRendererReport, OfAPlainSceneHasNothingToShowOfWhatIsNotCalledFor) {
  const Sequence plain = tests::resting_sequence(1);
  ExperimentOptions options = quick_renderer();
  options.frames = "0";
  const RendererReport report = measure_renderer_report(plain, options);
  const tests::TemporaryFolder folder;
  write_report(report, folder.path());
  EXPECT_FALSE(folder.names().contains("knob-texture-filter.png"));
  const std::string table = tests::printed(report);
  EXPECT_THAT(table, HasSubstr("no material has a texture"));
  EXPECT_EQ(table.find("Effects over time"), std::string::npos);
}

TEST(MeasureRendererReport, DefaultsFitTheDisplayAndTheNumberOfFrames) {
  Sequence large = tests::resting_sequence(100);
  large.display_px = {1024, 256};
  large.frames = 100;
  ExperimentOptions options;
  options.progress = "none";
  const RendererReport report = measure_renderer_report(large, options);
  EXPECT_EQ(report.display_px, layers::ivec2(512, 128));
  EXPECT_EQ(report.knobs.frames.size(), std::size_t(kDefaultRendererSamples));
  EXPECT_EQ(report.effects.run_load.frames.size(), std::size_t(kDefaultRun_frames));
}

TEST(MeasureRendererReport, BadOptionsAreNamed) {
  tests::expect_bad_options_named(
      quick_renderer(), [](const ExperimentOptions& options) { measure_renderer_report(shown(), options); });
}

TEST(RunAccuracy, OfTheRendererNamesASequenceThatIsNotThere) {
  AccuracyOptions options;
  options.renderer = "nowhere";
  std::ostringstream out;
  EXPECT_THAT(tests::message_of([&] { run_accuracy(options, out); }), HasSubstr("'nowhere' is no sequence"));
}

}  // namespace
}  // namespace talisman::sequences
