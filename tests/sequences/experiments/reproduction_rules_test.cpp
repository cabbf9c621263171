// SPDX-License-Identifier: Apache-2.0
// Every rule of a reproduced row can fail: each is fed with what it must say yes to, and with what it must say no to.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/experiments/reproduction/barnyard_pictures.h"
#include "sequences/experiments/reproduction/figure_21.h"
#include "sequences/experiments/reproduction/figure_22.h"
#include "sequences/experiments/reproduction/figure_23.h"
#include "sequences/experiments/reproduction/figure_24.h"
#include "sequences/experiments/reproduction/figures_15_16.h"
#include "sequences/experiments/reproduction/machine.h"
#include "sequences/experiments/reproduction/moving_average.h"
#include "sequences/experiments/reproduction/shadow_appendix.h"
#include "sequences/experiments/reproduction/speed_ups.h"

namespace talisman::sequences {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

TEST(MovingAverage, HasWholeWindowsAlone) {
  EXPECT_THAT(moving_average({1, 2, 6, 4}, 3), ElementsAre(3, 4));
  EXPECT_THAT(moving_average({1, 2}, 3), ElementsAre());
  EXPECT_THAT(moving_average({5, 7}, 1), ElementsAre(5, 7));
}

// Five beats of three frames in 15, wherever the window begins.
TEST(MovingAverage, OfTripleFramingDoesNotWave) {
  std::vector<double> beats;
  for (int frame = 0; frame < 40; ++frame) beats.push_back(frame % 3 == 0 ? 90 : 0);
  for (const double average : moving_average(beats)) EXPECT_DOUBLE_EQ(average, 30);
}

TEST(SharesOf, AreNumberByNumberAndNoneOfNothing) {
  const std::vector<double> shares = shares_of({1, 6, 5, 0}, {2, 4, 0, 0});
  EXPECT_THAT(std::vector<double>(shares.begin(), shares.begin() + 2), ElementsAre(0.5, 1.5));
  EXPECT_TRUE(std::isnan(shares[2]));
  EXPECT_TRUE(std::isnan(shares[3]));
}

TEST(LargestOf, IsInfiniteWithoutANumber) {
  EXPECT_EQ(largest_of({-3, -1, -2}), -1);
  EXPECT_EQ(largest_of({1, kNoNumber, 2}), HUGE_VAL);
}

// --- Fig. 22

/// Triple framing draws 90 in one frame of three; a threshold draws `per_frame` in each.
ResourceUse use_of(const std::vector<double>& per_frame) {
  std::vector<double> held;
  for (int frame = 0; frame < 30; ++frame) held.push_back(frame % 3 == 0 ? 90 : 0);
  std::vector<std::vector<double>> thresholds;
  for (const double each : per_frame) thresholds.emplace_back(30, each);
  return resource_use("polygons", held, held, thresholds);
}

TEST(Figure22, NormalisesEachWindowByTripleFraming) {
  const ResourceUse use = use_of({24, 15, 6, 3});
  ASSERT_EQ(use.thresholds.size(), 4u);
  EXPECT_EQ(use.thresholds[0].name, "0.1 px");
  ASSERT_EQ(use.thresholds[0].shares.size(), 16u);  // 30 - 15 + 1
  for (const double share : use.thresholds[0].shares) EXPECT_DOUBLE_EQ(share, 24.0 / 30);
  for (const double share : use.thresholds[3].shares) EXPECT_DOUBLE_EQ(share, 0.1);
  for (const double share : use.interpolation.shares) EXPECT_DOUBLE_EQ(share, 1);
}

TEST(Figure22, OneWindowAboveTripleFramingIsANo) {
  EXPECT_TRUE(below_triple_framing(use_of({24, 15, 6, 3})).same);
  EXPECT_FALSE(below_triple_framing(use_of({30, 15, 6, 3})).same) << "equal is not below";
  ResourceUse once = use_of({24, 15, 6, 3});
  once.thresholds[2].shares[7] = 1.01;
  EXPECT_FALSE(below_triple_framing(once).same);
  once.thresholds[2].shares[7] = kNoNumber;
  EXPECT_FALSE(below_triple_framing(once).same);
  EXPECT_FALSE(below_triple_framing(resource_use("", {1}, {1}, {{1}, {1}, {1}, {1}})).same) << "no window";
}

TEST(Figure22, AThresholdThatCostsMoreThanTheFinerOneIsANo) {
  EXPECT_TRUE(falling_with_threshold(use_of({24, 15, 6, 3})).same);
  EXPECT_FALSE(falling_with_threshold(use_of({24, 15, 15, 3})).same);
  EXPECT_FALSE(falling_with_threshold(use_of({24, 15, 16, 3})).same);
}

TEST(Figure22, InterpolationThatCostsMoreIsANo) {
  ResourceUse use = use_of({24, 15, 6, 3});
  EXPECT_TRUE(interpolation_costs_the_same(use).same);
  use.interpolated = 1.03;
  EXPECT_FALSE(interpolation_costs_the_same(use).same);
  use.interpolated = kNoNumber;  // held draws nothing
  EXPECT_FALSE(interpolation_costs_the_same(use).same);
}

// --- Fig. 23

PixelErrors errors_of(const std::vector<double>& beat, int beats = 10) {
  PixelErrors errors;
  for (int k = 0; k < beats; ++k)
    for (const double px : beat) {
      errors.held_px.push_back(px);
      errors.interpolated_px.push_back(px / 4);
    }
  errors.thresholds = {{0.1, {0.05, 0.08}, 0.1}, {0.8, {0.3, 0.6}, 0.79}};
  return errors;
}

TEST(Figure23, ASawToothIsNothingHalfAndFull) {
  EXPECT_TRUE(is_saw_tooth(errors_of({0, 1, 2})).same);
  EXPECT_TRUE(is_saw_tooth(errors_of({0, 0.82, 2})).same);
  EXPECT_FALSE(is_saw_tooth(errors_of({0, 0.78, 2})).same) << "a third, not a half";
  EXPECT_FALSE(is_saw_tooth(errors_of({0, 1.22, 2})).same);
  EXPECT_FALSE(is_saw_tooth(errors_of({0.1, 1, 2})).same) << "something is left where all was drawn";
  EXPECT_FALSE(is_saw_tooth(errors_of({0, 0, 0})).same) << "no error at all";
}

// Halves in the mean, but hardly in any beat.
TEST(Figure23, BeatsThatAreNoSawToothByThemselvesAreANo) {
  PixelErrors errors = errors_of({0, 0.4, 2, 0, 1.6, 2});
  EXPECT_DOUBLE_EQ(saw_tooth_of(errors.held_px).middle, 0.5);
  EXPECT_EQ(saw_tooth_of(errors.held_px).beats_in_shape, 0);
  EXPECT_FALSE(is_saw_tooth(errors).same);
}

TEST(Figure23, AnErrorAboveItsThresholdIsANo) {
  PixelErrors errors = errors_of({0, 1, 2});
  EXPECT_TRUE(thresholds_are_kept(errors).same);
  errors.thresholds[1].mean_px[0] = 0.81;
  EXPECT_FALSE(thresholds_are_kept(errors).same);
  errors = errors_of({0, 1, 2});
  errors.thresholds[0].largest_px = 0.11;
  EXPECT_FALSE(thresholds_are_kept(errors).same) << "one layer in one frame";
  errors.thresholds.clear();
  EXPECT_FALSE(thresholds_are_kept(errors).same);
}

TEST(Figure23, ThePremiseNeedsALargerErrorThanTheLargestThreshold) {
  EXPECT_TRUE(premise_holds(errors_of({0, 0.5, 0.9})).same);
  EXPECT_FALSE(premise_holds(errors_of({0, 0.4, 0.8})).same);
  EXPECT_FALSE(premise_holds(errors_of({0, 1, kNoNumber})).same);
}

TEST(Figure23, InterpolationThatIsHardlyBetterIsANo) {
  PixelErrors errors = errors_of({0, 1, 2});
  EXPECT_TRUE(interpolation_is_better(errors).same);
  errors.interpolated_px.assign(errors.held_px.size(), 0.6);
  EXPECT_FALSE(interpolation_is_better(errors).same);
}

// --- Fig. 21

CanyonRates rates_of(double land, double ship, int sky_renders = 1) {
  CanyonRates rates;
  rates.sprites = {{"sky", 90'000, sky_renders, sky_renders / 250.0},
                   {"land", 5000, 0, land},
                   {"leader", 900, 0, ship},
                   {"pod", 100, 0, 0.05}};
  return rates;
}

TEST(Figure21, RatesOutsideTheirRangeAreANo) {
  CanyonRates rates;
  rates.mean = 0.25, rates.weighted = 0.40, rates.polygons = 0.42;
  EXPECT_TRUE(mean_rate(rates).same && weighted_rate(rates).same && polygon_share(rates).same);
  rates.mean = 0.26, rates.weighted = 0.41, rates.polygons = 0.43;
  EXPECT_FALSE(mean_rate(rates).same || weighted_rate(rates).same || polygon_share(rates).same);
  rates.mean = 0, rates.weighted = 0.24, rates.polygons = 0.24;
  EXPECT_FALSE(mean_rate(rates).same || weighted_rate(rates).same || polygon_share(rates).same);
}

TEST(Figure21, ASkyThatIsDrawnTwiceOrIsNoneIsANo) {
  EXPECT_TRUE(sky_once(rates_of(0.9, 0.3)).same);
  EXPECT_FALSE(sky_once(rates_of(0.9, 0.3, 2)).same);
  EXPECT_FALSE(sky_once(CanyonRates{}).same);
}

TEST(Figure21, LandIsTheLayerWithMostPolygonsBesideTheSky) {
  EXPECT_TRUE(land_most_often(rates_of(0.9, 0.3)).same);
  EXPECT_FALSE(land_most_often(rates_of(0.2, 0.3)).same);
  EXPECT_FALSE(land_most_often(CanyonRates{}).same);
}

TEST(Figure21, AShipAbove35PerCentIsANo) {
  EXPECT_TRUE(ship_parts(rates_of(0.9, 0.35)).same);
  EXPECT_FALSE(ship_parts(rates_of(0.9, 0.36)).same);
  EXPECT_FALSE(ship_parts(CanyonRates{}).same);
}

// --- Fig. 24

TEST(Figure24, ResolutionsAreCountedByArea) {
  // 0.64² = 41 %, 0.7² = 49 %; 0.45 a side is 20 %.
  EXPECT_TRUE(reduced_layers({{1, 0.64, 0.7}, {}}).same);
  EXPECT_FALSE(reduced_layers({{1, 0.64, 0.45}, {}}).same);
  EXPECT_FALSE(reduced_layers({{1, 1}, {}}).same) << "none is reduced";
}

TEST(Figure24, LayersAndTheSharedSpriteAreCounted) {
  EXPECT_TRUE(layer_count({std::vector<double>(80, 1), {}}).same);
  EXPECT_FALSE(layer_count({std::vector<double>(79, 1), {}}).same);
  EXPECT_TRUE(wing_and_tailgate({{}, {"left wing + tailgate"}}).same);
  EXPECT_FALSE(wing_and_tailgate({{}, {"left wing + door", "tailgate + hen"}}).same);
  EXPECT_FALSE(wing_and_tailgate({}).same);
}

TEST(Figure24, PixelsAboveTheirShareAreANo) {
  EXPECT_TRUE(pixels_of_reference({60, 100, 200}).same);
  EXPECT_TRUE(pixels_of_full({60, 100, 200}).same);
  EXPECT_FALSE(pixels_of_reference({61, 100, 200}).same);
  EXPECT_FALSE(pixels_of_full({61, 100, 200}).same);
  EXPECT_FALSE(pixels_of_reference({0, 0, 0}).same) << "nothing was drawn";
}

// --- Speed-ups, machine

TEST(SpeedUps, OneOutsideTheRangeIsANo) {
  EXPECT_TRUE(all_in_range({{"a", 3}, {"b", 5}}, 3, 5).same);
  EXPECT_FALSE(all_in_range({{"a", 3}, {"b", 5.1}}, 3, 5).same);
  EXPECT_FALSE(all_in_range({{"a", 2.9}}, 3, 5).same);
  EXPECT_FALSE(all_in_range({}, 3, 5).same);
  const Finding nothing_drawn = all_in_range({{"a", HUGE_VAL}}, 3, 5);
  EXPECT_FALSE(nothing_drawn.same);
  EXPECT_THAT(nothing_drawn.ours, HasSubstr("a without end"));
}

// 320e6 / (1344 · 1024 · 75) = 3.1002, 40e6 / 75 / (1344 · 1024) = 0.38753.
TEST(PublishedMachine, HasTheLimitsThatFollowFromItsRates) {
  EXPECT_NEAR(machine_limits().depth, 3.1002, 1e-4);
  EXPECT_NEAR(machine_limits().screen, 0.38753, 1e-5);
  EXPECT_NEAR(machine_limits().frame_ms, 13.3333, 1e-4);
  EXPECT_TRUE(limit_of_depth(machine_limits()).same && limit_of_screen(machine_limits()).same);
  EXPECT_FALSE(limit_of_depth({5.4, 0.39, 13}).same) << "1024 x 768";
  EXPECT_FALSE(limit_of_screen({3.1, 0.51, 13}).same);
}

TEST(PublishedMachine, ADeeperFrameIsANo) {
  const MachineLimits limits{3.1, 0.39, 10};
  EXPECT_TRUE(depth_is_kept({{"a", {1, 3}, {}, {}}}, limits).same);
  EXPECT_FALSE(depth_is_kept({{"a", {1, 3.2}, {}, {}}}, limits).same);
  EXPECT_FALSE(depth_is_kept({{"a", {1, kNoNumber}, {}, {}}}, limits).same);
  EXPECT_FALSE(depth_is_kept({}, limits).same);
}

TEST(PublishedMachine, OnDemandFewerFramesMissOrNone) {
  const MachineLimits limits{3.1, 0.39, 10};
  EXPECT_TRUE(fewer_frames_miss({{"a", {}, {5, 11, 5}, {11, 11, 11}}}, limits).same);
  EXPECT_TRUE(fewer_frames_miss({{"a", {}, {5, 5}, {9, 9}}}, limits).same);
  EXPECT_FALSE(fewer_frames_miss({{"a", {}, {11, 11}, {11, 11}}}, limits).same);
}

// --- Fig. 15 and 16, pictures

UpdateCurve curve_of(warp::Curve curve, const std::vector<int>& renders) { return {curve, renders, 300}; }

// 4 px is no high error, at 64 px affine warps render once: only 8 and 16 px count. There 22/20 and 11/10.
TEST(Figure16, HomogeneousMetricsAreJudgedWhereTheErrorIsHighAndInTheirNorm) {
  const std::vector<double> px = {4, 8, 16, 64};
  const auto found = [&](const std::vector<int>& per, const std::vector<int>& peri) {
    return homogeneous_is_worse_at_high_error(
        {curve_of(warp::Curve::aff, {50, 20, 10, 1}), curve_of(warp::Curve::affi, {40, 10, 10, 1}),
         curve_of(warp::Curve::per, per), curve_of(warp::Curve::peri, peri)},
        px);
  };
  const Finding slightly = found({10, 22, 11, 9}, {10, 11, 11, 9});
  EXPECT_TRUE(slightly.same) << slightly.ours;
  EXPECT_THAT(slightly.numbers[0].second, testing::DoubleNear(1.1, 1e-12));
  EXPECT_THAT(slightly.numbers[1].second, testing::DoubleNear(1.1, 1e-12));
  EXPECT_FALSE(found({10, 22, 11, 9}, {10, 10, 10, 9}).same) << "peri as good as affi";
  EXPECT_FALSE(found({10, 30, 15, 9}, {10, 11, 11, 9}).same) << "much worse";
}

TEST(StatementAsAFinding, OrderAloneIsTheShape) {
  EXPECT_TRUE(finding_of({"", "so 1.05", Agreement::OrderOnly}).same);
  EXPECT_THAT(finding_of({"", "so 1.05", Agreement::OrderOnly}).ours, HasSubstr("closer than 10 %"));
  EXPECT_FALSE(finding_of({"", "so 0.9", Agreement::No}).same);
}

TEST(BarnyardPictures, AreComparedWithHeldTripleFraming) {
  EXPECT_TRUE(interpolation_is_seen({{"held", 0.2}, {"interpolated", 0.1}}).same);
  EXPECT_FALSE(interpolation_is_seen({{"held", 0.2}, {"interpolated", 0.11}}).same);
  EXPECT_FALSE(interpolation_is_seen({}).same);
  const SeenError held{"held", 0.2}, interpolated{"interpolated", 0.1};
  EXPECT_TRUE(thresholds_look_alike({held, interpolated, {"0.1 px", 0.01}, {"0.8 px", 0.05}}).same);
  EXPECT_FALSE(thresholds_look_alike({held, interpolated, {"0.1 px", 0.01}, {"0.8 px", 0.06}}).same);
  EXPECT_FALSE(thresholds_look_alike({held, {"", 0.02}, {"0.1 px", 0.03}}).same);
  EXPECT_FALSE(thresholds_look_alike({held, interpolated}).same);
}

// --- The appendix

TEST(ShadowAppendix, TheCompositorKeepsTheRules) {
  const std::vector<ShadowTexel> texels = shadow_texels(0.6, 0.1);
  ASSERT_EQ(texels.size(), 65u * 65u);
  for (const Finding& finding : {right_where_whole_or_lit(texels), wrong_as_the_formula_says(texels),
                                 worst_in_half_coverage(texels, 0.6, 0.1)})
    EXPECT_TRUE(finding.same) << finding.ours;
}

// In full shadow, covered by half: [0, 0] wanted over half of 0.1; over gives [0.25 B, …].
TEST(ShadowAppendix, HasAQuarterOfTheDifferenceInHalfCoverage) {
  for (const ShadowTexel& texel : shadow_texels(0.6, 0.1)) {
    if (texel.s != 0 || texel.beta != 0.5) continue;
    EXPECT_DOUBLE_EQ(texel.formula, 0.25 * 0.5);
    EXPECT_NEAR(texel.error, 0.125, kShadowRounding);
  }
}

TEST(ShadowAppendix, AnotherCompositorIsANo) {
  std::vector<ShadowTexel> exact = shadow_texels(0.6, 0.1);
  for (ShadowTexel& texel : exact) texel.error = 0;  // as a multiplying one would be
  EXPECT_TRUE(right_where_whole_or_lit(exact).same);
  EXPECT_FALSE(wrong_as_the_formula_says(exact).same);
  EXPECT_FALSE(worst_in_half_coverage(exact, 0.6, 0.1).same);
  std::vector<ShadowTexel> wrong = shadow_texels(0.6, 0.1);
  wrong.back().error = 0.02;  // s = 1, whole
  EXPECT_FALSE(right_where_whole_or_lit(wrong).same);
  EXPECT_FALSE(right_where_whole_or_lit({}).same || wrong_as_the_formula_says({}).same ||
               worst_in_half_coverage({}, 0.6, 0.1).same);
}

}  // namespace
}  // namespace talisman::sequences
