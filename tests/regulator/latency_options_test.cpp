// SPDX-License-Identifier: Apache-2.0
#include "regulator/latency_options.h"

#include <cmath>

#include <gtest/gtest.h>

#include "regulator/plan.h"

namespace talisman::regulator {
namespace {

TEST(LatencyOptions, PredictionsAreReadByTheNamesThatTheyHave) {
  for (const Prediction prediction : kAllPredictions)
    EXPECT_EQ(prediction_from_name(name(prediction)), prediction) << name(prediction);
  EXPECT_EQ(prediction_from_name("oracle"), std::nullopt);
}

TEST(LatencyOptions, AreLateWhereAnOldPoseIsAllThatIsKnown) {
  EXPECT_FALSE(is_late(LatencyOptions{}));
  EXPECT_TRUE(is_late(LatencyOptions{20, kNoLastWarp_ms, Prediction::Held}));
  EXPECT_FALSE(is_late(LatencyOptions{20, 5, Prediction::Known}));
  EXPECT_TRUE(warps_last({20, 5, Prediction::Linear}));
  EXPECT_TRUE(warps_last({20, 0, Prediction::Held}));
  EXPECT_FALSE(warps_last({20, 20, Prediction::Held})) << "it knows no more than the picture";
  EXPECT_FALSE(warps_last({20, kNoLastWarp_ms, Prediction::Held}));
  EXPECT_FALSE(warps_last({0, 0, Prediction::Held}));
}

TEST(LatencyOptions, BrokenRulesAreNamed) {
  EXPECT_EQ(first_defect(LatencyOptions{}), "");
  EXPECT_EQ(first_defect(LatencyOptions{20, 20, Prediction::Held}), "");
  EXPECT_EQ(first_defect(LatencyOptions{-1, kNoLastWarp_ms, Prediction::Held}),
            "latency_ms is -1, must be from 0 to 1000");
  EXPECT_NE(first_defect(LatencyOptions{1001, kNoLastWarp_ms, Prediction::Held}), "");
  EXPECT_NE(first_defect(LatencyOptions{NAN, kNoLastWarp_ms, Prediction::Held}), "");
  EXPECT_NE(first_defect(LatencyOptions{20, NAN, Prediction::Held}), "");
  EXPECT_NE(first_defect(LatencyOptions{20, -1, Prediction::Held}), "");
  EXPECT_EQ(
      first_defect(LatencyOptions{20, 30, Prediction::Held}),
      "latency_warp_ms is 30, must be from 0 to latency_ms, which is 20: the last warp knows no older pose "
      "than the picture");
  RegulatorOptions options;
  options.latency.render_ms = -3;
  EXPECT_NE(first_defect(options), "");
  options.latency.render_ms = 3;
  EXPECT_EQ(first_defect(options), "");
  options.kalman.jerk_rad = 0;
  EXPECT_EQ(first_defect(options), "kalman_jerk_rad is 0, must be from 1e-12 to 1e12");
  options.kalman = {};
  options.kalman.coast_s = 1e-9;
  EXPECT_EQ(first_defect(options), "kalman_coast_s is 1e-09, must be 0 (for ever), or from 1e-6 to 1e6");
  options.kalman.coast_s = 0.25;
  EXPECT_EQ(first_defect(options), "");
  options.kalman.push_s = NAN;
  EXPECT_NE(first_defect(options), "");
}

}  // namespace
}  // namespace talisman::regulator
