// SPDX-License-Identifier: Apache-2.0
// Tables of [F96]: rules that say no to what is wrong, and the cells that are worked out.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/experiments/reproduction/fearing/operations.h"
#include "sequences/experiments/reproduction/fearing/skipped.h"

namespace talisman::sequences {
namespace {

TEST(Fearing, ClosedFormOfSkippedPolygons) {
  EXPECT_DOUBLE_EQ(skipped_share(0.25, 100, 2), 0.125);
  EXPECT_DOUBLE_EQ(skipped_share(0.99, 100, 8), 0.99 * 0.87);
  EXPECT_DOUBLE_EQ(skipped_share(1, 100, 100), 0.99);
  EXPECT_DOUBLE_EQ(skipped_share(1, 1, 32), 0);
}

TEST(Fearing, ACellThatIsOffByItsLastDigitIsRefused) {
  EXPECT_TRUE(table_5_26({{1, 32, 95.04, 95.04, 95.04}}).same);
  EXPECT_FALSE(table_5_26({{1, 32, 95.04, 95.05, 95.05}}).same);
  EXPECT_FALSE(table_5_26({{1, 32, 95.04, 95.04, 95.0399}}).same)
      << "counted, and not what the closed form says";
  EXPECT_FALSE(table_5_26({}).same);
}

TEST(Fearing, EveryOperationCountIsAsPrintedOrAKnownMisprint) {
  const std::vector<OperationCell> cells = operation_cells();
  std::set<std::string> tables;
  int misprints = 0;
  for (const OperationCell& cell : cells) {
    tables.insert(cell.table);
    misprints += is_known_misprint(cell);
    EXPECT_EQ(cell.agrees(), !is_known_misprint(cell))
        << cell.table << " " << cell.what << ": " << cell.printed << ", worked out " << cell.ours;
  }
  EXPECT_EQ(tables.size(), 22u);
  EXPECT_EQ(misprints, 10);
}

TEST(Fearing, CorrectedCellsHaveTheseValues) {
  const auto ours = [](const std::string& table, const std::string& what) {
    for (const OperationCell& cell : operation_cells())
      if (cell.table == table && cell.what == what) return cell.ours;
    return -1.0;
  };
  EXPECT_EQ(ours("4.18", "totals, adds (rend)"), 428'000);
  EXPECT_EQ(ours("4.10", "molecules (local), mults"), 72'000'000);
  EXPECT_EQ(ours("4.11", "particles (infinite), adds"), 21'312'000);
  EXPECT_EQ(ours("4.20", "2nd vertex trans, mults (rend)"), 4'608'000);
  EXPECT_EQ(ours("4.20", "totals, mults (rend)"), 162'432'000);
  EXPECT_EQ(ours("4.22", "trans, mults (pred)"), 112'000);
  EXPECT_EQ(ours("4.22", "viewport, comps (pred)"), 20'000);
  EXPECT_EQ(ours("4.23", "viewport, comps (pred)"), 30'000);
}

TEST(Fearing, AnUnknownMisprintIsRefused) {
  std::vector<OperationCell> cells = {{"4.7", "random, mults", 48e3, 48e3}};
  EXPECT_TRUE(operations_of("4.7", cells).same);
  cells.push_back({"4.7", "blocks, mults", 288e3, 288'001});
  const Finding finding = operations_of("4.7", cells);
  EXPECT_FALSE(finding.same);
  EXPECT_THAT(finding.ours, testing::HasSubstr("corrected: blocks, mults 288,001 for 288,000"));
  EXPECT_FALSE(operations_of("4.99", cells).same);
}

}  // namespace
}  // namespace talisman::sequences
