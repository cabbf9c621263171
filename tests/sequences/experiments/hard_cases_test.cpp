// SPDX-License-Identifier: Apache-2.0
// The hard cases of `talisman accuracy --hard`, stage by stage, and what the table is made of.
#include "sequences/experiments/hard/hard_case.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sequences/experiments/hard/report.h"

namespace talisman::sequences {
namespace {

class HardCases : public ::testing::TestWithParam<HardStage> {};

TEST_P(HardCases, KeepTheirRules) {
  for (const HardCase& hard : all_hard_cases()) {
    if (hard.stage != GetParam()) continue;
    const MeasuredHardCase m = measure_hard_case(hard);
    EXPECT_NE(m.status, HardStatus::Broken)
        << hard.name << ", " << hard.special << ": " << m.outcome.error << " " << hard.rule.unit
        << ", rule: " << hard.rule.most << (hard.rule.refused ? " and a refusal" : " and an answer")
        << (m.outcome.refused ? ", refused" : ", answered");
  }
}

INSTANTIATE_TEST_SUITE_P(Of, HardCases, ::testing::ValuesIn(kAllHardStages),
                         [](const auto& info) { return std::string(name(info.param)); });

TEST(AllHardCases, EveryStageHasSomeWithNamesOfTheirOwn) {
  std::set<std::pair<HardStage, std::string_view>> names;
  std::set<HardStage> stages;
  const std::vector<HardCase> cases = all_hard_cases();
  double least = 1, most = 1;
  for (const HardCase& hard : cases) {
    EXPECT_TRUE(names.insert({hard.stage, hard.name}).second) << hard.name;
    EXPECT_FALSE(hard.special.empty() || hard.rule.unit.empty() || hard.rule.oracle.empty()) << hard.name;
    EXPECT_TRUE(hard.extreme > 0 && std::isfinite(hard.extreme)) << hard.name;
    EXPECT_TRUE(hard.rule.most >= 0 && std::isfinite(hard.rule.most)) << hard.name;
    stages.insert(hard.stage);
    least = std::min(least, hard.extreme), most = std::max(most, hard.extreme);
  }
  EXPECT_EQ(stages.size(), std::size(kAllHardStages));
  EXPECT_GE(cases.size(), 60u);
  EXPECT_GE(std::log10(most / least), 12);
}

HardCase case_with(double error, double most, bool refused, bool to_be_refused) {
  return {HardStage::Warps, "name", "special", 1, {most, "px", "by hand", to_be_refused}, [error, refused] {
            return HardOutcome{error, refused};
          }};
}

// Every way in which a rule can be broken, and the two in which it is kept.
TEST(MeasureHardCase, OnlyTheRightAnswerHolds) {
  const auto status = [](double error, double most, bool refused, bool to_be_refused) {
    return measure_hard_case(case_with(error, most, refused, to_be_refused)).status;
  };
  EXPECT_EQ(status(0.5, 1, false, false), HardStatus::Holds);
  EXPECT_EQ(status(1, 1, false, false), HardStatus::Holds);
  EXPECT_EQ(status(0, 0, true, true), HardStatus::Refused);
  EXPECT_EQ(status(1.5, 1, false, false), HardStatus::Broken);
  EXPECT_EQ(status(NAN, 1, false, false), HardStatus::Broken);
  EXPECT_EQ(status(HUGE_VAL, 1, false, false), HardStatus::Broken);
  EXPECT_EQ(status(0, 1, true, false), HardStatus::Broken) << "no answer where there is one";
  EXPECT_EQ(status(0, 1, false, true), HardStatus::Broken) << "an answer where there is none";
  EXPECT_EQ(status(2, 1, true, true), HardStatus::Broken) << "a refusal that says something wrong";
}

// std::max(worst, NaN) is `worst`: a stage without an answer would look right.
TEST(Worse, NotANumberIsTheWorst) {
  EXPECT_EQ(worse(1.0, 2.0), 2.0);
  EXPECT_EQ(worse(2.0, 1.0), 2.0);
  EXPECT_EQ(worse(2.0, double(NAN)), HUGE_VAL);
  EXPECT_EQ(worse(double(NAN), 2.0), HUGE_VAL);
}

// Once per decade: rounding grows with the distance, in either width, and the one is 2^29 times the other.
TEST(MeasureNumberWidths, DoubleIsRightWhereFloatIsNotAndTheToolIsAsGoodAsDouble) {
  const WidthCurves curves = measure_number_widths();
  ASSERT_EQ(curves.fits.size(), 5u);
  ASSERT_EQ(curves.projections.size(), 5u);
  const auto at = [](const WidthCurve& curve, int decade) { return curve.points[2 * decade].error_px; };
  for (const std::vector<WidthCurve>* group : {&curves.fits, &curves.projections})
    for (const WidthCurve& curve : *group) {
      ASSERT_EQ(curve.points.size(), 25u);
      EXPECT_EQ(curve.points.back().ratio, 1e12);
    }
  // A millionth of a pixel is lost by the formula as printed, in double, for a sprite 10,000 times its size away.
  EXPECT_GT(at(curves.fits[1], 4), 1e-6);
  EXPECT_LT(at(curves.fits[3], 4), 1e-9);
  EXPECT_GT(at(curves.fits[0], 3), 1);
  for (int decade = 0; decade <= 12; ++decade) {
    EXPECT_LT(at(curves.fits[4], decade), 1e-11 * std::pow(10, decade)) << decade;
    EXPECT_LT(at(curves.projections[4], decade), 1e-12 * std::pow(10, decade)) << decade;
  }
}

}  // namespace
}  // namespace talisman::sequences
