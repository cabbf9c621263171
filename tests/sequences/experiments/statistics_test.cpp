// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/statistics.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using testing::ElementsAre;
using Values = std::vector<double>;

TEST(Ranks, TiesShareTheMeanOfTheRanksTheyTakeUp) {
  EXPECT_THAT(ranks(Values{30, 10, 20, 20}), ElementsAre(4, 1, 2.5, 2.5));
  EXPECT_THAT(ranks(Values{7, 7, 7}), ElementsAre(2, 2, 2));
  EXPECT_THAT(ranks(Values{}), ElementsAre());
}

TEST(Spearman, TextbookExampleWithoutTies) {
  // Intelligence quotient and hours of television of ten people: Σ d² = 194, ρ = 1 - 6 · 194 / 990.
  const Values iq{106, 100, 86, 101, 99, 103, 97, 113, 112, 110}, hours{7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
  const RankCorrelation rank = spearman(iq, hours);
  EXPECT_TRUE(rank.defined);
  EXPECT_EQ(rank.n, 10);
  EXPECT_NEAR(rank.rho, -29.0 / 165, 1e-15);
}

TEST(Spearman, TiesByHand) {
  // Ranks 1, 2½, 2½, 4 against 1, 3, 2, 4: deviations give 4.5 / √(4.5 · 5).
  EXPECT_NEAR(spearman(Values{1, 2, 2, 3}, Values{10, 30, 20, 40}).rho, 4.5 / std::sqrt(22.5), 1e-15);
}

TEST(Spearman, OnlyTheOrderMatters) {
  Values x, up, down;
  for (int i = 0; i < 50; ++i) {
    x.push_back(0.1 * i);
    up.push_back(std::exp(x.back()));
    down.push_back(1e6 - std::pow(x.back(), 5));
  }
  EXPECT_DOUBLE_EQ(spearman(x, up).rho, 1);
  EXPECT_DOUBLE_EQ(spearman(x, down).rho, -1);
}

TEST(Spearman, NothingToCorrelateIsReported) {
  EXPECT_FALSE(spearman(Values{}, Values{}).defined);
  EXPECT_FALSE(spearman(Values{1}, Values{2}).defined);
  EXPECT_FALSE(spearman(Values{1, 2, 3}, Values{5, 5, 5}).defined) << "a constant says nothing";
  EXPECT_EQ(spearman(Values{5, 5, 5}, Values{1, 2, 3}).rho, 0);
}

TEST(Spearman, PairsThatAreNotNumbersAreLeftOut) {
  const RankCorrelation rank = spearman(Values{1, NAN, 2, 3, 4}, Values{1, 9, 2, HUGE_VAL, 3});
  EXPECT_EQ(rank.n, 3);
  EXPECT_DOUBLE_EQ(rank.rho, 1);
}

/// Ranks by counting, correlation by the definition.
double slow_spearman(const Values& x, const Values& y) {
  const auto slow_ranks = [](const Values& v) {
    Values r;
    for (const double a : v) {
      int below = 0, equal = 0;
      for (const double b : v) below += b < a, equal += b == a;
      r.push_back(below + (equal + 1) / 2.0);
    }
    return r;
  };
  const Values rx = slow_ranks(x), ry = slow_ranks(y);
  const double n = double(x.size());
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += rx[i], sy += ry[i];
    sxx += rx[i] * rx[i], syy += ry[i] * ry[i], sxy += rx[i] * ry[i];
  }
  return (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
}

TEST(Spearman, AgreesWithASlowOracleOnRandomNumbersWithManyTies) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Values x, y;
    for (unsigned i = 0; i < 5 + seed; ++i) {
      x.push_back(random() % 9);
      y.push_back(x.back() + random() % 9);
    }
    const RankCorrelation rank = spearman(x, y);
    ASSERT_TRUE(rank.defined);
    EXPECT_NEAR(rank.rho, slow_spearman(x, y), 1e-12);
  }
}

TEST(Quantile, InterpolatesBetweenNeighbours) {
  EXPECT_EQ(quantile(Values{4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(quantile(Values{9, 1, 5}, 0.5), 5);
  EXPECT_EQ(quantile(Values{1, 2, 3, 4, 5}, 0.25), 2);
  EXPECT_EQ(quantile(Values{3, 1}, 0), 1);
  EXPECT_EQ(quantile(Values{3, 1}, 1), 3);
}

TEST(Quantile, EmptyAndNotFinite) {
  EXPECT_EQ(quantile(Values{}, 0.5), 0);
  EXPECT_EQ(quantile(Values{NAN, 7, HUGE_VAL}, 0.5), 7);
}

TEST(ParetoFront, WhatIsBeatenIsNotOnIt) {
  using testing::ElementsAre;
  EXPECT_THAT(pareto_front({1, 2, 3, 4}, {9, 5, 6, 1}), ElementsAre(true, true, false, true));
  EXPECT_THAT(pareto_front({4, 3, 2, 1}, {1, 6, 5, 9}), ElementsAre(true, false, true, true));
}

TEST(ParetoFront, TiesAndNotANumber) {
  using testing::ElementsAre;
  EXPECT_THAT(pareto_front({1, 1, 1}, {2, 1, 1}), ElementsAre(false, true, false));
  EXPECT_THAT(pareto_front({1, 2}, {3, 3}), ElementsAre(true, false));
  EXPECT_THAT(pareto_front({NAN, 1, 2}, {0, NAN, 5}), ElementsAre(false, false, true));
  EXPECT_TRUE(pareto_front({}, {}).empty());
}

TEST(ParetoFront, SmallGainsCountForNothingWhereOneIsAskedFor) {
  using testing::ElementsAre;
  EXPECT_THAT(pareto_front({1, 2, 3}, {1, 0.95, 0.5}, 0.1), ElementsAre(true, false, true));
  // Against the last that counted, not against the last that was looked at.
  EXPECT_THAT(pareto_front({1, 2, 3}, {1, 0.95, 0.89}, 0.1), ElementsAre(true, false, true));
}

TEST(Median, OfAnEvenNumberLiesBetween) {
  EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median(std::vector<double>{NAN, 7}), 7);
}

TEST(RmsCodeValues, IsWhatPsnrSays) {
  EXPECT_NEAR(rms_code_values(20 * std::log10(255 / 3.0)), 3, 1e-12);
  EXPECT_EQ(rms_code_values(HUGE_VAL), 0);
}

}  // namespace
}  // namespace talisman::sequences
