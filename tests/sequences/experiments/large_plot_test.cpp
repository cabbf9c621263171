// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/large_plot.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

TEST(FrontSeries, GoesFromTheCheapestToTheDearestAndLeavesTheOthersOut) {
  const PlotSeries series = front_series({3, 1, 2}, {10, 30, 25}, {true, true, false});
  ASSERT_EQ(series.points.size(), 2u);
  EXPECT_EQ(series.points[0].x, 1);
  EXPECT_EQ(series.points[0].y, 30);
  EXPECT_EQ(series.points[1].x, 3);
  EXPECT_EQ(series.points[1].y, 10);
  EXPECT_TRUE(front_series({}, {}, {}).points.empty());
}

}  // namespace
}  // namespace talisman::sequences
