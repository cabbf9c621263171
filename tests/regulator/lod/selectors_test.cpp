// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/selectors.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "regulator/lod/benefit.h"

namespace talisman::regulator {
namespace {

constexpr std::array<std::int64_t, 3> kTriangles = {100, 40, 10};

TEST(LevelBySize, IsTheFinestWithTrianglesOfThatSize) {
  EXPECT_EQ(level_by_size(102'400, kTriangles, 1024), 0);
  EXPECT_EQ(level_by_size(102'399, kTriangles, 1024), 1);
  EXPECT_EQ(level_by_size(40'960, kTriangles, 1024), 1);
  EXPECT_EQ(level_by_size(10'240, kTriangles, 1024), 2);
  EXPECT_EQ(level_by_size(5, kTriangles, 1024), 2) << "nothing is that coarse: the coarsest";
  EXPECT_EQ(level_by_size(0, kTriangles, 0), 0);
  EXPECT_EQ(level_by_size(0, kTriangles, 1), 2);
}

TEST(Feedback, AddsInProportionToTheOverrunAndIsClamped) {
  EXPECT_DOUBLE_EQ(next_px_per_polygon(100, 20, 10, 256), 356);
  EXPECT_DOUBLE_EQ(next_px_per_polygon(100, 10, 10, 256), 100);
  EXPECT_DOUBLE_EQ(next_px_per_polygon(100, 5, 10, 256), 0);
  EXPECT_DOUBLE_EQ(next_px_per_polygon(0, 15, 10, 256), 128) << "it rises again from 0";
  EXPECT_DOUBLE_EQ(next_px_per_polygon(0, 1e9, 10, 256), 256 * kMostOverrun);
  EXPECT_DOUBLE_EQ(next_px_per_polygon(0, 1, 0, 256), 256 * kMostOverrun) << "a target of 0";
  EXPECT_DOUBLE_EQ(next_px_per_polygon(0, std::numeric_limits<double>::quiet_NaN(), 1, 1), kMostOverrun);
  double s = 0;
  for (int frame = 0; frame < 10'000; ++frame) s = next_px_per_polygon(s, 1e6, 1, 256);
  EXPECT_EQ(s, kMostPxPerPolygon);
}

/// In a simple view S collapses to 0; then what is complex is drawn in full once: the overshoot of [Fu93 4.5].
TEST(Feedback, OvershootsWhereAComplexViewFollowsASimpleOne) {
  const auto frame_ms = [](double s, double pixels) {
    return 0.1 *
           static_cast<double>(kTriangles[static_cast<std::size_t>(level_by_size(pixels, kTriangles, s))]);
  };
  double s = 1024, worst = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const double pixels = frame < 30 ? 100 : 10'000;
    const double ms = frame < 30 ? 0.5 : frame_ms(s, pixels);
    if (frame == 29) {
      EXPECT_EQ(s, 0);
    }
    worst = std::max(worst, ms);
    s = next_px_per_polygon(s, ms, 5, 256);
  }
  EXPECT_EQ(worst, 10);
}

TEST(LodWords, AreReadAsTheyAreWritten) {
  for (const auto selector : kAllLodSelectors) EXPECT_EQ(lod_selector_from_name(name(selector)), selector);
  for (const auto benefit : kAllLodBenefits) EXPECT_EQ(lod_benefit_from_name(name(benefit)), benefit);
  for (const auto first : kAllFirstAppearances) EXPECT_EQ(first_appearance_from_name(name(first)), first);
  EXPECT_FALSE(lod_selector_from_name("optimize"));
  EXPECT_EQ(first_defect(LodOptions{}), "");
  LodOptions options;
  options.px_per_polygon = -1;
  EXPECT_NE(first_defect(options), "");
  options = {};
  options.feedback_gain = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(first_defect(options), "");
}

TEST(SpherePx, IsTheDiscOfTheSphereAndNeverMoreThanTheDisplay) {
  EXPECT_NEAR(sphere_px(1, 10, 1000, 1e6), std::numbers::pi * 1e4, 1e-6);
  EXPECT_EQ(sphere_px(1, 0.5, 1000, 1e6), 1e6);
  EXPECT_EQ(sphere_px(1, std::numeric_limits<double>::quiet_NaN(), 1000, 1e6), 1e6);
  EXPECT_EQ(sphere_px(0, 0, 1000, 1e6), 0);
  EXPECT_EQ(sphere_px(1, 1.001, 1e9, 1e6), 1e6);
}

TEST(Accuracy, IsHalfForOneSampleAndRisesWithTheSquareForGouraud) {
  LodView view;
  view.size_px = 1e6;
  EXPECT_EQ(accuracy(view, LodShading::Flat), 0.5);
  view.triangles = 10;
  view.vertices = 10;
  EXPECT_DOUBLE_EQ(accuracy(view, LodShading::Flat), 0.95);
  EXPECT_DOUBLE_EQ(accuracy(view, LodShading::Gouraud), 0.995);
  EXPECT_DOUBLE_EQ(accuracy(view, LodShading::Pixel), 1 - 0.5e-6);
  view.size_px = 2;  // never more samples than pixels
  EXPECT_DOUBLE_EQ(accuracy(view, LodShading::Flat), 0.75);
  view.size_px = 0;
  EXPECT_EQ(accuracy(view, LodShading::Flat), 0.5);
}

TEST(PrintedBenefit, IsTheProductOfSixFactors) {
  LodView view;
  view.size_px = 900;
  view.triangles = 9;
  view.importance = 0.5;
  view.from_centre = 0.5;
  view.px_per_frame = 5;
  view.levels_switched = 2;
  const LodWeights weights{0.4, 1, 0.1};
  const double expected = 900 * (1 - 0.5 / 9) * 0.5 * (1 - 0.2) * (1 - 5.0 / 10) * (1 - 0.2);
  EXPECT_DOUBLE_EQ(printed_benefit(view, LodShading::Flat, weights), expected);
  view.px_per_frame = 1e9;
  EXPECT_EQ(printed_benefit(view, LodShading::Flat, weights), 0);
  EXPECT_DOUBLE_EQ(printed_benefit(view, LodShading::Flat, {0, 0, 0}), 900 * (1 - 0.5 / 9) * 0.5);
  view.size_px = 0;
  EXPECT_EQ(printed_benefit(view, LodShading::Flat, weights), 0);
}

TEST(ErrorBenefit, IsWhatTheErrorFallsBy) {
  EXPECT_EQ(error_benefit(7, 2, 2), 10);
  EXPECT_EQ(error_benefit(2, 7, 2), 0);
  EXPECT_EQ(error_benefit(HUGE_VAL, 0, 1), kMostLodError_px);
  EXPECT_EQ(error_benefit(std::numeric_limits<double>::quiet_NaN(), 0, 1), kMostLodError_px);
}

}  // namespace
}  // namespace talisman::regulator
