// SPDX-License-Identifier: Apache-2.0
// `accuracy --hard` from the command to its files.
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/accuracy.h"
#include "sequences/experiments/hard/report.h"
#include "tests/sequences/commands/experiment_files.h"
#include "tests/sequences/csv_rows.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;

TEST(RunHardAccuracy, WritesALinePerCaseAndThePlotsAndSucceeds) {
  const tests::TemporaryFolder folder;
  AccuracyOptions options;
  options.hard = true;
  options.out = folder.path();
  options.progress = "none";
  std::ostringstream out;
  EXPECT_EQ(run_accuracy(options, out), kSuccess) << out.str();
  EXPECT_EQ(tests::rows_of(folder.read("hard.csv")).size(), 1 + all_hard_cases().size());
  tests::expect_files(folder, {"hard-cases.svg", "hard-cases.csv", "hard-fit.svg", "hard-fit.csv",
                               "hard-projection.svg", "hard-projection.csv"});
  for (const HardStage stage : kAllHardStages)
    EXPECT_THAT(out.str(), HasSubstr(std::string(name(stage)) + "\ncase "));
  EXPECT_THAT(out.str(), HasSubstr(" 0 are broken"));
}

TEST(RunHardAccuracy, IsOneOfTheExperiments) {
  AccuracyOptions options;
  options.hard = options.solvers = true;
  std::ostringstream out;
  EXPECT_THAT(tests::message_of([&] { run_accuracy(options, out); }), HasSubstr("more than one experiment"));
}

/// A report whose second case is broken.
HardReport broken_report() {
  HardReport report;
  for (const double error : {0.5, 2.5})
    report.cases.push_back(measure_hard_case({HardStage::Order,
                                              error < 1 ? "kept, \"so\"" : "torn",
                                              "special",
                                              1e6,
                                              {1, "px", "by hand"},
                                              [error] {
                                                return HardOutcome{error, false};
                                              }}));
  return report;
}

TEST(PrintHardReport, NamesWhatIsBrokenWithItsNumbers) {
  const std::string out = plain_text(page_of(broken_report()));
  EXPECT_THAT(out,
              HasSubstr("2 cases, extremes 1 ... 1e+06: 1 hold, 0 are refused as they should, 1 are broken"));
  EXPECT_THAT(out, HasSubstr("broken: order, torn: 2.5 px, rule: <= 1 px"));
  EXPECT_EQ(broken_cases(broken_report()), 1);
}

TEST(WriteHardReport, QuotesTexts) {
  const tests::TemporaryFolder folder;
  write_report(broken_report(), folder.path());
  EXPECT_THAT(
      folder.read("hard.csv"),
      HasSubstr("order,\"kept, \"\"so\"\"\",\"special\",1000000,1,\"px\",\"by hand\",0,0.5,\"holds\"\n"));
}

}  // namespace
}  // namespace talisman::sequences
