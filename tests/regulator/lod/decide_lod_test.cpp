// SPDX-License-Identifier: Apache-2.0
// One frame, decided by hand. On talisman-1996 1,500 polygons take a millisecond, and so do 40,000 pixels.
#include "regulator/lod/decide_lod.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

RegulatorOptions lod_budget(double ms) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.ms = ms;
  options.budget.depth_complexity = 1;
  options.lod.by = LodSelector::Optimise;
  return options;
}

/// Levels of 1500, 750 and 375 polygons: 1, 0.5 and 0.25 ms, off by 0, 1 and 4 px; 100 × 100 pixels: 0.25 ms.
LayerAssessment appearing(int layer) {
  LayerAssessment a;
  a.layer = layer;
  a.in_view = true;
  a.cost = {1500, 10'000, 16, 0};
  for (int k = 0; k < 3; ++k) {
    LevelChoice way{k, 1, a.cost, k == 0 ? 0.0 : k == 1 ? 1.0 : 4.0};
    way.cost.polygons = 1500 >> k;
    a.levels.push_back(way);
  }
  return a;
}

/// With a sprite of a level, whose warp is off.
LayerAssessment seen(int layer, int level, double warp_px) {
  LayerAssessment a = appearing(layer);
  a.has_sprite = true;
  a.identical = warp_px == 0;
  a.matched_points = 8;
  a.fitted.status = warp::FitStatus::Converged;
  a.fiducials.geometric.px = warp_px;
  a.level_then = level;
  a.level_then_px = a.levels[static_cast<std::size_t>(level)].error_px;
  a.frames_since_render = 1;
  return a;
}

FramePlan plan_of(std::vector<LayerAssessment> layers, const RegulatorOptions& options) {
  return regulate(0, layers, options);
}

TEST(DecideLod, WhatAppearsIsAsFineAsTheBudgetAffords) {
  const auto level_at = [](double ms) { return plan_of({appearing(0)}, lod_budget(ms)).decisions[0].level; };
  EXPECT_EQ(level_at(1), 0);
  EXPECT_EQ(level_at(0.99), 1);
  EXPECT_EQ(level_at(0.49), 2);
  const FramePlan plan = plan_of({appearing(0)}, lod_budget(0.2));
  EXPECT_EQ(plan.decisions[0].level, 2);
  EXPECT_EQ(plan.decisions[0].action, Action::Rerender);
  EXPECT_FALSE(plan.lod->fits);
  EXPECT_THAT(plan.decisions[0].reason, HasSubstr("first_appearance; level 2 of 3; overdraws budget"));
  EXPECT_EQ(plan.decisions[0].shown_geometric_px, 4);
}

TEST(DecideLod, SkippedLayersAreSaidAndNotShown) {
  RegulatorOptions options = lod_budget(0.3);
  options.lod.first_appearance = FirstAppearance::Skip;
  const FramePlan plan = plan_of({appearing(0), appearing(1)}, options);
  EXPECT_EQ(plan.decisions[0].action, Action::Rerender);
  EXPECT_EQ(plan.decisions[1].action, Action::Drop);
  EXPECT_TRUE(plan.decisions[1].skipped);
  EXPECT_THAT(plan.decisions[1].reason, StartsWith("skipped: budget, needs 0.25 ms"));
  EXPECT_EQ(plan.lod->skipped, 1);
  LayerAssessment base = appearing(1);
  base.may_be_skipped = false;
  EXPECT_EQ(plan_of({appearing(0), base}, options).decisions[1].action, Action::Rerender);
}

TEST(DecideLod, DrawTakesTheFinestWhateverItCosts) {
  RegulatorOptions options = lod_budget(0.3);
  options.lod.first_appearance = FirstAppearance::Draw;
  const FramePlan plan = plan_of({appearing(0)}, options);
  EXPECT_EQ(plan.decisions[0].level, 0);
  EXPECT_FALSE(plan.lod->fits);
}

/// The warp of one is off by 10 px, the level of the other by 4: there is time for one render at the finest, or two coarser.
TEST(DecideLod, SpendsWhereTheErrorFallsMost) {
  const FramePlan plan = plan_of({seen(0, 0, 10), seen(1, 2, 0)}, lod_budget(1));
  // 0: level 1 for 0.5 ms takes 9 px; 1: level 1 for 0.5 ms takes 3 px. Together 12; level 0 of either alone 10 or 4.
  EXPECT_EQ(plan.decisions[0].level, 1);
  EXPECT_EQ(plan.decisions[1].level, 1);
  EXPECT_DOUBLE_EQ(plan.lod->benefit, 12);
  EXPECT_DOUBLE_EQ(plan.lod->cost_ms, 1);
  EXPECT_THAT(plan.decisions[0].reason, StartsWith("benefit 9 > 0.004 px; level 1 of 3"));
}

TEST(DecideLod, WhatRestsIsRefinedWhenThereIsTimeAndThenLeftAlone) {
  EXPECT_EQ(plan_of({seen(0, 2, 0)}, lod_budget(1)).decisions[0].level, 0);
  const LayerDecision fine = plan_of({seen(0, 0, 0)}, lod_budget(1)).decisions[0];
  EXPECT_EQ(fine.action, Action::Reuse);
  EXPECT_EQ(fine.reason, "unchanged; level 0 of 3");
  const LayerDecision coarse = plan_of({seen(0, 2, 0)}, lod_budget(0)).decisions[0];
  EXPECT_EQ(coarse.action, Action::Reuse);
  EXPECT_TRUE(coarse.deferred);
  EXPECT_EQ(coarse.level, 2);
  EXPECT_EQ(coarse.shown_geometric_px, 4) << "the error of its level is part of what is shown";
}

/// What no warp carries soundly would be shown in the wrong place: it is drawn as if it appeared.
TEST(DecideLod, ASpriteWithoutASoundWarpIsDrawnAgainWhateverIsLeft) {
  LayerAssessment lost = seen(0, 0, 50);
  lost.matched_points = 0;
  const FramePlan plan = plan_of({lost}, lod_budget(0.1));
  EXPECT_EQ(plan.decisions[0].action, Action::Rerender);
  EXPECT_EQ(plan.decisions[0].level, 2);
  EXPECT_FALSE(plan.lod->fits);
  for (LevelChoice& way : lost.levels) way.error_px = 1e6;  // the eye is inside of it
  EXPECT_EQ(plan_of({lost}, lod_budget(0.1)).decisions.size(), 1u);
}

TEST(DecideLod, PrintedBenefitsKeepASpriteThatIsNotOff) {
  RegulatorOptions options = lod_budget(0.5);
  options.lod.benefit = LodBenefit::Printed;
  const FramePlan plan = plan_of({seen(0, 0, 0.1), seen(1, 0, 100)}, options);
  EXPECT_EQ(plan.decisions[0].action, Action::Reuse);
  EXPECT_EQ(plan.decisions[1].action, Action::Rerender);
}

TEST(DecideLod, NothingInViewIsAPlan) {
  LayerAssessment out = appearing(0);
  out.in_view = false;
  const FramePlan plan = plan_of({out}, lod_budget(0));
  EXPECT_EQ(plan.decisions[0].reason, "out_of_view");
  EXPECT_TRUE(plan.lod->fits);
  EXPECT_TRUE(plan_of({}, lod_budget(1)).decisions.empty());
}

TEST(SayLevels, OtherPoliciesDrawTheLevelThatWasChosenForThem) {
  RegulatorOptions options = lod_budget(kNoLimitMs);
  options.policy = Policy::Threshold;
  options.lod.by = LodSelector::Static;
  LayerAssessment fresh = appearing(0), old = seen(1, 2, 1);
  fresh.level = old.level = 1;
  old.fiducials.geometric.px += old.level_then_px - old.levels[1].error_px;  // what a render would mend
  const FramePlan plan = plan_of({fresh, old}, options);
  EXPECT_EQ(plan.decisions[0].reason, "first_appearance; level 1 of 3");
  EXPECT_EQ(plan.decisions[0].shown_geometric_px, 1);
  EXPECT_EQ(plan.decisions[1].action, Action::Reuse);
  EXPECT_EQ(plan.decisions[1].level, 2);
  EXPECT_DOUBLE_EQ(plan.decisions[1].shown_geometric_px, 1 + 4) << "its warp's and its level's";
  options.thresholds.geometric_px = 3;
  EXPECT_EQ(plan_of({fresh, old}, options).decisions[1].level, 1);
}

TEST(ChoosesLevels, OnlyWhereThePolicyKnowsHow) {
  RegulatorOptions options = lod_budget(1);
  EXPECT_TRUE(chooses_levels(options));
  options.policy = Policy::Direct;
  EXPECT_FALSE(chooses_levels(options));
  options.lod.by = LodSelector::Static;
  EXPECT_FALSE(chooses_levels(options));
  options.policy = Policy::Reference;
  EXPECT_TRUE(chooses_levels(options));
  options.lod.by = LodSelector::None;
  EXPECT_FALSE(chooses_levels(options));
}

}  // namespace
}  // namespace talisman::regulator
