// SPDX-License-Identifier: Apache-2.0
// `accuracy --solvers` from the command to its files.
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/accuracy.h"
#include "sequences/experiments/warps/solver_ladder.h"
#include "tests/sequences/csv_rows.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

TEST(RunAccuracy, NumbersOfBoxesOutOfRangeAreABadArgument) {
  std::ostringstream out;
  AccuracyOptions options;
  options.solvers = true;
  for (const int inputs : {0, -1, 100001}) {
    options.inputs = inputs;
    EXPECT_THAT(tests::message_of([&] { run_accuracy(options, out); }),
                testing::HasSubstr("--inputs " + std::to_string(inputs)));
  }
}

TEST(RunAccuracy, WritesOneLinePerSolverAndSizeAndThePlots) {
  const tests::TemporaryFolder folder;
  AccuracyOptions options;
  options.solvers = true;
  options.out = folder.path();
  options.progress = "none";
  options.inputs = 2;
  std::ostringstream out;
  EXPECT_EQ(run_accuracy(options, out), kSuccess);
  const tests::CsvRows rows = tests::rows_of(folder.read("solvers.csv"));
  EXPECT_EQ(rows.size(), 1 + 5 * solver_ladder().size());
  std::size_t front = 0;
  for (const std::vector<std::string>& row : rows) front += row.back() == "1";
  EXPECT_GE(front, 2u);
  for (const char* name : {"solvers.svg", "solvers-affine.svg", "solvers-perspective.svg"})
    EXPECT_GT(folder.read(name).size(), 1000u) << name;
  EXPECT_THAT(out.str(), testing::HasSubstr("normal eq. float32"));
}

}  // namespace
}  // namespace talisman::sequences
