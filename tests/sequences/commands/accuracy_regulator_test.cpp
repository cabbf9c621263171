// SPDX-License-Identifier: Apache-2.0
// `accuracy --regulator` from the command to its files.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/accuracy.h"
#include "sequences/commands/accuracy_regulator.h"
#include "tests/sequences/commands/experiment_files.h"
#include "tests/sequences/csv_rows.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;
using tests::rows_of;
using tests::without_times;

ExperimentOptions quick_regulator() { return tests::quick_options("0-17", "64x48", 6); }

const Sequence& moving() {
  static const Sequence sequence = tests::moving_sequence(48);
  return sequence;
}

class RegulatorReportFiles : public testing::Test {
 protected:
  static const RegulatorReport& report() {
    static const RegulatorReport measured = measure_regulator_report(moving(), quick_regulator());
    return measured;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(RegulatorReportFiles, AllAreThere) {
  write_report(report(), folder_.path());
  tests::expect_files(folder_, {"regulator.csv", "regulator.json", "regulator.svg", "regulator-polygons.svg",
                                "regulator-bound.svg", "regulator-popping.svg", "lookahead.csv",
                                "lookahead.svg", "calibration.csv", "calibration-geometric.svg",
                                "calibration-magnification.svg", "calibration-visibility.svg"});
}

TEST_F(RegulatorReportFiles, CsvHasOneFullLinePerSettingWithFiniteNumbers) {
  const auto rows = rows_of(settings_csv(report()));
  ASSERT_EQ(rows.size(), 1 + report().settings.size());
  EXPECT_EQ(rows[0][0], "policy");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), rows[0].size());
    for (std::size_t c = 3; c < rows[k].size(); ++c) {
      if (k == 1 && rows[0][c] == "psnr_db") {
        EXPECT_EQ(rows[k][c], "") << "the reference equals itself";
        continue;
      }
      if (rows[0][c].rfind("popping", 0) == 0 && rows[k][c].empty()) {
        EXPECT_EQ(report().settings[k - 1].popping.frames_with_steps, 0)
            << "only where nothing was drawn again";
        continue;
      }
      EXPECT_TRUE(!rows[k][c].empty() && std::isfinite(std::stod(rows[k][c]))) << rows[0][c] << " line " << k;
    }
  }
}

TEST_F(RegulatorReportFiles, SamplesNameTheirLayerAndQuoteIt) {
  RegulatorReport odd = report();
  ASSERT_FALSE(odd.samples.empty());
  odd.samples.resize(1);
  odd.layers[odd.samples[0].layer] = "wing \"left\"";
  EXPECT_THAT(samples_csv(odd), HasSubstr(",\"wing \"\"left\"\"\","));
  EXPECT_THAT(samples_csv(odd), HasSubstr("geometric_px,magnification_percent"));
}

TEST_F(RegulatorReportFiles, JsonSaysWhatWasMeasured) {
  const nlohmann::json json = nlohmann::json::parse(json_of(report()));
  EXPECT_EQ(json["schema"], "talisman.regulator/1");
  EXPECT_EQ(json["settings_given"]["geometric_px"], report().given.regulator.thresholds.geometric_px);
  EXPECT_GT(json["settings_given"].size(), 20u);
  EXPECT_EQ(json["display_px"], (nlohmann::json{64, 48}));
  EXPECT_EQ(json["quality_every"], 6);
  EXPECT_EQ(json["settings"].size(), report().settings.size());
  EXPECT_TRUE(json["settings"][0]["psnr_db"].is_null());
  EXPECT_EQ(json["lookahead"]["points"].size(), 2 * compared_lookaheads().size()) << "known and predicted";
  EXPECT_EQ(json["calibration"].size(), calibrated_fiducials().size());
}

TEST_F(RegulatorReportFiles, AllButTheTimesIsTheSameInEveryRun) {
  const RegulatorReport again = measure_regulator_report(moving(), quick_regulator());
  EXPECT_EQ(without_times(settings_csv(again)), without_times(settings_csv(report())));
  EXPECT_EQ(samples_csv(again), samples_csv(report()));
}

TEST_F(RegulatorReportFiles, OneFrameIsEnough) {
  ExperimentOptions options = quick_regulator();
  options.frames = "0";
  const RegulatorReport single = measure_regulator_report(moving(), options);
  EXPECT_TRUE(single.samples.empty()) << "there is no older sprite";
  write_report(single, folder_.path());
  EXPECT_THAT(folder_.read("calibration-geometric.svg"), HasSubstr("no data"));
  EXPECT_THAT(tests::printed(single), HasSubstr("frames 0-0, 64x48 px; all planned"));
}

TEST_F(RegulatorReportFiles, TheTableSaysWhatWasUsed) {
  tests::expect_table(tests::printed(report()),
                      {"frames 0-17, 64x48 px; all planned, 3 of them drawn", "lookahead 16", "oracle"});
}

TEST(MeasureRegulatorReport, DefaultsFitTheDisplayAndTheNumberOfFrames) {
  Sequence large = tests::moving_sequence(3);
  large.display_px = {1024, 256};
  ExperimentOptions options;
  options.progress = "none";
  const RegulatorReport report = measure_regulator_report(large, options);
  EXPECT_EQ(report.display_px, layers::ivec2(512, 128));
  EXPECT_EQ(report.lookahead.display_px, layers::ivec2(1024, 256)) << "plans are made at full size";
  EXPECT_EQ(report.frames.first, 0);
  EXPECT_EQ(report.frames.last, 2);
  EXPECT_EQ(report.frames.every, 1);
}

TEST(MeasureRegulatorReport, BadOptionsAreNamed) {
  tests::expect_bad_options_named(quick_regulator(), [](const ExperimentOptions& options) {
    measure_regulator_report(moving(), options);
  });
}

TEST(RunAccuracy, ExactlyOneExperimentMustBeAskedFor) {
  std::ostringstream out;
  AccuracyOptions none, both, others;
  both.solvers = true;
  both.regulator = "canyon";
  others.regulator = others.renderer = "canyon";
  EXPECT_THAT(tests::message_of([&] { run_accuracy(none, out); }), HasSubstr("nothing to measure"));
  EXPECT_THAT(tests::message_of([&] { run_accuracy(both, out); }), HasSubstr("more than one experiment"));
  EXPECT_THAT(tests::message_of([&] { run_accuracy(others, out); }), HasSubstr("more than one experiment"));
}

}  // namespace
}  // namespace talisman::sequences
