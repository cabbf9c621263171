// SPDX-License-Identifier: Apache-2.0
#include "warp/color.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/correspondences.h"
#include "warp/fit.h"

namespace talisman::warp {
namespace {

using layers::dvec3;
using tests::Random;

std::vector<dvec3> random_colours(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<dvec3> colours(count);
  for (auto& c : colours)
    for (int k = 0; k < 3; ++k) c[k] = random.uniform(0, 1);
  return colours;
}

TEST(FitColor, ExactMultipliersAreRecovered) {
  const auto then = random_colours(1, 8);
  auto now = then;
  for (auto& c : now) c *= dvec3{0.5, 1.25, 2};
  const ColorFit fitted = fit_color(then, now);
  EXPECT_NEAR(fitted.multiplier.x, 0.5, 1e-14);
  EXPECT_NEAR(fitted.multiplier.y, 1.25, 1e-14);
  EXPECT_NEAR(fitted.multiplier.z, 2, 1e-14);
  EXPECT_LT(fitted.max, 1e-14);
  for (ColorStatus status : fitted.status) EXPECT_EQ(status, ColorStatus::Converged);
}

TEST(FitColor, NoOtherMultiplierIsBetter) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto then = random_colours(seed, 14), now = random_colours(seed + 1000, 14);
    const ColorFit fitted = fit_color(then, now);
    for (int channel = 0; channel < 3; ++channel)
      for (double nudge : {-1e-3, 1e-3}) {
        double best = 0, other = 0;
        for (std::size_t i = 0; i < then.size(); ++i) {
          best += std::pow(fitted.multiplier[channel] * then[i][channel] - now[i][channel], 2);
          other += std::pow((fitted.multiplier[channel] + nudge) * then[i][channel] - now[i][channel], 2);
        }
        EXPECT_LT(best, other) << "seed " << seed;
      }
  }
}

// A multiplier cannot bring light to what was black; it stays 1 and the error says what is missing.
TEST(FitColor, ABlackChannelKeepsItsMultiplierAndShowsTheError) {
  const std::vector<dvec3> then{{0, 0.5, 0}, {0, 0.25, 0}}, now{{0.3, 0.5, 0}, {0.3, 0.25, 0}};
  const ColorFit fitted = fit_color(then, now);
  EXPECT_EQ(fitted.multiplier, dvec3(1, 1, 1));
  EXPECT_EQ(fitted.status[0], ColorStatus::Black);
  EXPECT_EQ(fitted.status[1], ColorStatus::Converged);
  EXPECT_EQ(fitted.status[2], ColorStatus::Black);
  EXPECT_DOUBLE_EQ(fitted.max, 0.3);
}

TEST(FitColor, LightsOutGivesZero) {
  const std::vector<dvec3> then{{1, 1, 1}}, now{{0, 0, 0}};
  const ColorFit fitted = fit_color(then, now);
  EXPECT_EQ(fitted.multiplier, dvec3(0, 0, 0));
  EXPECT_EQ(fitted.max, 0);
}

TEST(FitColor, NoPointsLeaveTheColourAlone) {
  const ColorFit fitted = fit_color({}, {});
  EXPECT_EQ(fitted.multiplier, dvec3(1, 1, 1));
  EXPECT_EQ(fitted.worst_point, -1);
  EXPECT_EQ(fitted.max, 0);
}

// From nearly black to bright: a quotient of 1e6 would multiply the quantisation of the sprite as well.
TEST(FitColor, LargeMultipliersAreLimited) {
  const std::vector<dvec3> then{{1e-6, 0.5, 0.5}}, now{{1, 0.5, 0.5}};
  const ColorFit fitted = fit_color(then, now);
  EXPECT_EQ(fitted.multiplier.x, 16);
  EXPECT_EQ(fitted.status[0], ColorStatus::Limited);
  EXPECT_EQ(fit_color(then, now, {.largest_multiplier = 4}).multiplier.x, 4);
}

// The squares of such colours are below the smallest double.
TEST(FitColor, TheDarkestColoursKeepTheirRatio) {
  const std::vector<dvec3> then{{1e-200, 1e-300, 1}}, now{{2e-200, 3e-300, 1}};
  const ColorFit fitted = fit_color(then, now);
  EXPECT_NEAR(fitted.multiplier.x, 2, 1e-12);
  EXPECT_NEAR(fitted.multiplier.y, 3, 1e-12);
}

TEST(FitColor, NotFiniteOrNegativeColoursAreReported) {
  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -0.1})
    for (int side = 0; side < 2; ++side) {
      auto then = random_colours(3, 4), now = then;
      (side == 0 ? then : now)[2].y = bad;
      const ColorFit fitted = fit_color(then, now);
      EXPECT_EQ(fitted.status[1], ColorStatus::NotFinite) << bad;
      EXPECT_EQ(fitted.status[0], ColorStatus::Converged) << bad;
      EXPECT_EQ(fitted.multiplier.y, 1) << bad;
      EXPECT_TRUE(std::isfinite(fitted.max) && std::isfinite(fitted.rms)) << bad;
      EXPECT_EQ(fitted.worst_point, 2) << bad;
    }
}

TEST(FitColor, ShadingAtRestIsExact) {
  const auto colours = random_colours(4, 14);
  const ColorFit fitted = fit_color(colours, colours);
  EXPECT_EQ(fitted.multiplier, dvec3(1, 1, 1));
  EXPECT_EQ(fitted.max, 0);
}

}  // namespace
}  // namespace talisman::warp
