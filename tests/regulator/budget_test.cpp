// SPDX-License-Identifier: Apache-2.0
// The budget regulator against hand-made frames, and its greedy choice against the best one.
#include "regulator/budget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/profile.h"

namespace talisman::regulator {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A layer in view, drawn before, whose warped sprite is `error_px` off.
LayerAssessment layer_of(int id, double error_px, std::int64_t polygons, std::int64_t pixels = 1000) {
  LayerAssessment layer;
  layer.layer = id;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 5;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fitted.warp.now_from_then[2][0] = 7;
  layer.fiducials.geometric.px = error_px;
  layer.held_geometric_px = 7 + error_px;
  layer.cost = {polygons, pixels, 1, 4096};
  return layer;
}

RegulatorOptions budget_of(std::int64_t polygons, std::int64_t pixels = kNoLimit) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.polygons = polygons;
  options.budget.pixels = pixels;
  return options;
}

std::vector<int> rendered(const std::vector<LayerDecision>& decisions) {
  std::vector<int> layers;
  for (const LayerDecision& d : decisions)
    if (d.action == Action::Rerender) layers.push_back(d.layer);
  return layers;
}

std::vector<LayerDecision> decide(const std::vector<LayerAssessment>& layers,
                                  const RegulatorOptions& options) {
  return regulate(10, layers, options).decisions;
}

TEST(BenefitPx, IsZeroAtRestAndTheGeometricErrorWhereOnlyThatIsOff) {
  EXPECT_EQ(benefit_px(layer_of(0, 0, 1)), 0);
  EXPECT_DOUBLE_EQ(benefit_px(layer_of(0, 2.5, 1)), 2.5);
}

TEST(BenefitPx, AddsEveryFiducialWeightedByImportance) {
  LayerAssessment layer = layer_of(0, 2, 1);
  layer.fiducials.sampling = {1.5, 0.5, 3, {0, 0}};  // smear 0.5 + 1 + 2 px
  layer.fiducials.visibility.uncovered_px = 4;
  EXPECT_DOUBLE_EQ(benefit_px(layer), 2 + 3.5) << "a fiducial that is not computed does not count";
  layer.fiducials.visibility.computed = true;
  EXPECT_DOUBLE_EQ(benefit_px(layer), 2 + 3.5 + 4);
  layer.preferences.importance = {10, 1, 2, 0.5};
  EXPECT_DOUBLE_EQ(benefit_px(layer), 20 + 7 + 2);
}

TEST(BenefitPx, IsFiniteForEverythingThatIsNot) {
  LayerAssessment layer = layer_of(0, NAN, 1);
  EXPECT_EQ(benefit_px(layer), kMostBenefitPx);
  layer = layer_of(0, warp::kHugePx, 1);
  EXPECT_EQ(benefit_px(layer), kMostBenefitPx);
  layer = layer_of(0, 1, 1);
  layer.fiducials.sampling.minification = 0;  // collapsed: 1 / 0
  EXPECT_EQ(benefit_px(layer), kMostBenefitPx);
  layer.preferences.importance.sampling = 0;  // 0 · ∞ must not become NaN
  EXPECT_DOUBLE_EQ(benefit_px(layer), 1);
}

TEST(BenefitPx, UnsoundFitsAndDueLayersGainTheMost) {
  // Two points are matched exactly by any affine map: no error, which means nothing.
  LayerAssessment layer = layer_of(0, 0, 1);
  layer.matched_points = 2;
  EXPECT_EQ(benefit_px(layer), kMostBenefitPx);
  layer.identical = true;
  EXPECT_EQ(benefit_px(layer), 0) << "nothing can be gained by drawing the same again";
  layer = layer_of(0, 0.1, 1);
  layer.preferences.min_update_rate = 0.2;  // every 5 frames, and 5 have gone by
  EXPECT_EQ(benefit_px(layer), kMostBenefitPx);
}

TEST(ShareOfBudget, AddsTheFractionsOfBothBudgets) {
  const LayerCost cost{50, 200, 1, 4096};
  EXPECT_DOUBLE_EQ(share_of_budget(cost, {100, 1000}), 0.5 + 0.2);
  EXPECT_DOUBLE_EQ(share_of_budget(cost, {100, kNoLimit}), 0.5);
  EXPECT_DOUBLE_EQ(share_of_budget(cost, {}), 0);
  EXPECT_TRUE(std::isfinite(share_of_budget(cost, {0, 0})));
}

TEST(SortByBenefitPerCost, RatioDecidesAndTiesGoToTheLowerId) {
  std::vector<Candidate> c = {{3, 4, {100}}, {1, 2, {50}}, {0, 1, {100}}, {2, 9, {100}}, {4, 0.1, {0}}};
  sort_by_benefit_per_cost(c, {1000, kNoLimit});
  std::vector<int> order;
  for (const Candidate& candidate : c) order.push_back(candidate.layer);
  EXPECT_THAT(order, ElementsAre(4, 2, 1, 3, 0)) << "what costs nothing is first; 1 and 3 tie";
}

TEST(SortByBenefitPerCost, WithoutAnyBudgetTheBenefitDecides) {
  std::vector<Candidate> c = {{0, 1, {1}}, {1, 3, {900}}, {2, 3, {1}}};
  sort_by_benefit_per_cost(c, {});
  EXPECT_EQ(c[0].layer, 1);
  EXPECT_EQ(c[1].layer, 2);
}

TEST(PolicyBudget, DrawsTheBestRatioFirstAndDefersWhatDoesNotFitWithNumbers) {
  const auto decisions =
      decide({layer_of(0, 8, 800), layer_of(1, 6, 300), layer_of(2, 1, 300)}, budget_of(1000));
  EXPECT_THAT(rendered(decisions), ElementsAre(1, 2)) << "0 no longer fits after 1, the cheaper 2 does";
  EXPECT_EQ(decisions[0].reason, "deferred: budget, polygons 800 > 700 left of 1000; benefit 8 > 0.004 px");
  EXPECT_EQ(decisions[0].action, Action::Reuse);
  EXPECT_DOUBLE_EQ(decisions[0].shown_geometric_px, 8) << "the error that is displayed is told";
  EXPECT_EQ(decisions[1].reason, "benefit 6 > 0.004 px");
}

TEST(PolicyBudget, PixelsAreABudgetOfTheirOwn) {
  const auto decisions =
      decide({layer_of(0, 8, 10, 5000), layer_of(1, 1, 10, 900)}, budget_of(kNoLimit, 1000));
  EXPECT_THAT(rendered(decisions), ElementsAre(1));
  EXPECT_EQ(
      decisions[0].reason,
      "deferred: budget, dearer than the whole budget of 1000 pixels, needs 5000; benefit 8 > 0.004 px");
  EXPECT_TRUE(decisions[0].short_of_area);
}

TEST(PolicyBudget, ChunksAreABudgetOfTheirOwn) {
  RegulatorOptions options = budget_of(kNoLimit);
  options.budget.chunks = 2;
  const auto decisions = decide({layer_of(0, 8, 10), layer_of(1, 7, 10), layer_of(2, 6, 10)}, options);
  EXPECT_THAT(rendered(decisions), ElementsAre(0, 1));
  EXPECT_THAT(decisions[2].reason, HasSubstr("chunks 1 > 0 left of 2"));
  EXPECT_TRUE(decisions[2].short_of_area);
}

TEST(PolicyBudget, LayerDearerThanAllPolygonsSaysSoAndIsNotShortOfArea) {
  // Its resolution does not help it, so it must not be lowered.
  const auto decisions = decide({layer_of(0, 8, 5000)}, budget_of(3000));
  EXPECT_EQ(
      decisions[0].reason,
      "deferred: budget, dearer than the whole budget of 3000 polygons, needs 5000; benefit 8 > 0.004 px");
  EXPECT_FALSE(decisions[0].short_of_area);
}

TEST(PolicyBudget, AllLayersEqualGoToTheLowerIdsInAnyOrderOfTheAssessments) {
  std::vector<LayerAssessment> layers;
  for (const int id : {4, 1, 3, 0, 2}) layers.push_back(layer_of(id, 5, 100, 100));
  for (int budget = 0; budget <= 5; ++budget) {
    std::vector<int> expected(budget), chosen = rendered(decide(layers, budget_of(100 * budget)));
    for (int i = 0; i < budget; ++i) expected[i] = i;
    std::sort(chosen.begin(), chosen.end());
    EXPECT_EQ(chosen, expected);
  }
}

TEST(PolicyBudget, BudgetBelowTheCheapestLayerDrawsNothing) {
  EXPECT_THAT(rendered(decide({layer_of(0, 9, 100), layer_of(1, 9, 120)}, budget_of(99))), ElementsAre());
  EXPECT_THAT(rendered(decide({layer_of(0, 9, 100), layer_of(1, 9, 120)}, budget_of(100))), ElementsAre(0));
}

TEST(FrameBudget, TimeLimitsPolygonsAndPixelsSoThatTheModelledRenderFits) {
  RegulatorOptions options;
  options.budget.ms = 2;
  const Budget budget = frame_budget(options);
  EXPECT_EQ(budget.polygons, 3000);
  EXPECT_EQ(budget.pixels, 80'000);
  EXPECT_EQ(budget.chunks, kNoLimit);
  EXPECT_LE(modelled_time(talisman_1996(), budget.polygons, budget.pixels, 0).render_ms, 2);
  EXPECT_GT(modelled_time(talisman_1996(), budget.polygons + 1, 0, 0).render_ms, 2);
  EXPECT_GT(modelled_time(talisman_1996(), 0, budget.pixels + 1, 0).render_ms, 2);
  options.budget.polygons = 10;
  EXPECT_EQ(frame_budget(options).polygons, 10) << "the scarcer of two limits holds";
  options.budget.ms = 1e300;
  EXPECT_EQ(frame_budget(options).pixels, kNoLimit);
  EXPECT_FALSE(is_limited(RegulatorOptions{}));
}

TEST(PolicyBudget, TimeIsNamedInTheReason) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.ms = 2;
  const auto decisions = decide({layer_of(0, 8, 2000), layer_of(1, 7, 2000)}, options);
  EXPECT_THAT(decisions[1].reason, HasSubstr("polygons 2000 > 1000 left of 3000 in 2 ms"));
}

TEST(RegulatorOptions, BudgetsOutOfRangeAreDefects) {
  RegulatorOptions options;
  options.budget.chunks = -1;
  EXPECT_EQ(first_defect(options), "budget_chunks is -1, must be at least 0");
  options = {};
  options.budget.ms = NAN;
  EXPECT_THAT(first_defect(options), HasSubstr("budget_ms"));
  options = {};
  options.budget.min_resolution = 0;
  EXPECT_EQ(first_defect(options), "min_resolution is 0, must be above 0 and at most 1");
}

TEST(PolicyBudget, NothingBelowTheCutOffIsDrawnHoweverMuchIsLeft) {
  const auto decisions = decide({layer_of(0, 0.003, 10), layer_of(1, 0.005, 10)}, budget_of(1'000'000));
  EXPECT_THAT(rendered(decisions), ElementsAre(1));
  EXPECT_EQ(decisions[0].reason, "benefit 0.003 <= 0.004 px");
}

TEST(PolicyBudget, FirstAppearancesComeFirstAndMayOverdraw) {
  std::vector<LayerAssessment> layers = {layer_of(0, 100, 10), layer_of(1, 0, 700), layer_of(2, 0, 800)};
  layers[1].has_sprite = layers[2].has_sprite = false;
  const auto decisions = decide(layers, budget_of(1000));
  EXPECT_THAT(rendered(decisions), ElementsAre(1, 2)) << "nothing is left for 0, however urgent and cheap";
  EXPECT_EQ(decisions[1].reason, "first_appearance");
  EXPECT_EQ(decisions[2].reason, "first_appearance; overdraws budget: polygons 800 > 300 left of 1000");
  EXPECT_THAT(decisions[0].reason, HasSubstr("polygons 10 > 0 left of 1000"));
}

TEST(PolicyBudget, ZeroBudgetDrawsOnlyFirstAppearances) {
  std::vector<LayerAssessment> layers = {layer_of(0, 9, 10), layer_of(1, 9, 10)};
  layers[1].has_sprite = false;
  EXPECT_THAT(rendered(decide(layers, budget_of(0, 0))), ElementsAre(1));
}

TEST(PolicyBudget, IdenticalLayersAndThoseBarredByTheirRateAreNotDrawn) {
  std::vector<LayerAssessment> layers = {layer_of(0, 0, 10), layer_of(1, 9, 10)};
  layers[0].identical = true;
  layers[1].preferences.max_update_rate = 0.1;  // 5 frames have gone by, 10 must
  const auto decisions = decide(layers, budget_of(kNoLimit));
  EXPECT_THAT(rendered(decisions), ElementsAre());
  EXPECT_EQ(decisions[0].reason, "unchanged");
  EXPECT_EQ(decisions[1].reason, "deferred: max_update_rate");
}

TEST(PolicyBudget, DeferredLayerWithoutASoundFitStaysInPlace) {
  LayerAssessment layer = layer_of(0, 9, 100);
  layer.fitted.status = warp::FitStatus::NotFinite;
  const auto decisions = decide({layer}, budget_of(10));
  EXPECT_TRUE(decisions[0].shown_warp.is_identity());
  EXPECT_THAT(decisions[0].reason, HasSubstr("no warp"));
}

std::vector<Candidate> random_candidates(std::mt19937& random, int n) {
  std::uniform_real_distribution<double> benefit(0.01, 10);
  std::uniform_int_distribution<std::int64_t> polygons(0, 1000), pixels(0, 50'000);
  std::vector<Candidate> candidates;
  for (int i = 0; i < n; ++i)
    candidates.push_back({i, benefit(random), {polygons(random), pixels(random), 1 + i % 20, 4096}});
  return candidates;
}

double best_by_brute_force(const std::vector<Candidate>& candidates, const Budget& budget) {
  double best = 0;
  for (unsigned subset = 0; subset < (1u << candidates.size()); ++subset) {
    LayerCost cost;
    double benefit = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if ((subset >> i & 1) == 0) continue;
      cost.polygons += candidates[i].cost.polygons;
      cost.pixels += candidates[i].cost.pixels;
      cost.chunks += candidates[i].cost.chunks;
      benefit += candidates[i].benefit_px;
    }
    if (budget.affords(cost)) best = std::max(best, benefit);
  }
  return best;
}

TEST(OptimalChoice, EqualsExhaustiveSearchWithOneAndTwoBudgets) {
  constexpr unsigned kSeed = 1997;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 120; ++trial) {
    const auto candidates = random_candidates(random, trial % 12);
    for (const Budget budget : {Budget{2000, kNoLimit}, Budget{kNoLimit, 90'000}, Budget{2000, 90'000},
                                Budget{2500, 120'000, 40}, Budget{0, 0}, Budget{}}) {
      const Choice choice = optimal_choice(candidates, budget);
      ASSERT_TRUE(choice.exact);
      EXPECT_DOUBLE_EQ(choice.benefit_px, best_by_brute_force(candidates, budget))
          << "seed " << kSeed << " trial " << trial;
      LayerCost spent;
      double benefit = 0;
      for (const int layer : choice.layers) {
        spent.polygons += candidates[layer].cost.polygons;
        spent.pixels += candidates[layer].cost.pixels;
        spent.chunks += candidates[layer].cost.chunks;
        benefit += candidates[layer].benefit_px;
      }
      EXPECT_TRUE(budget.affords(spent));
      EXPECT_DOUBLE_EQ(benefit, choice.benefit_px) << "the layers named are those that were counted";
    }
  }
}

TEST(OptimalChoice, TooManyStatesAreAnsweredByGreedyAndSaySo) {
  std::mt19937 random(5);
  const auto candidates = random_candidates(random, 30);
  const Choice capped = optimal_choice(candidates, {8000, 400'000}, 10);
  EXPECT_FALSE(capped.exact);
  EXPECT_EQ(capped.layers, greedy_choice(candidates, {8000, 400'000}).layers);
}

TEST(OptimalChoice, HundredLayersAreSolvedWithinTheStatesOfAFrame) {
  // The bound on what the rest can add is what makes this possible: 2^119 choices, few of them promising.
  constexpr unsigned kSeed = 119;
  std::mt19937 random(kSeed);
  const auto candidates = random_candidates(random, 119);
  const BudgetGap gap = budget_gap(candidates, {20'000, kNoLimit});
  EXPECT_TRUE(gap.exact) << "seed " << kSeed;
  EXPECT_GE(gap.optimal_px, gap.greedy_px);
  EXPECT_LT(gap.gap(), 0.02);
}

TEST(GreedyGap, NeverNegativeAndNearlyWholeInTheWorstCase) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 100; ++trial) {
    const double gap = greedy_gap(random_candidates(random, 14), {3000, 150'000});
    EXPECT_GE(gap, 0) << "seed " << kSeed << " trial " << trial;
    EXPECT_LT(gap, 0.5) << "seed " << kSeed << " trial " << trial;
  }
  EXPECT_EQ(greedy_gap({}, {100, 100}), 0);
  // The textbook trap: a crumb of a slightly better ratio keeps out the layer that fills the budget.
  const std::vector<Candidate> trap = {{0, 1.01, {10}}, {1, 100, {1000}}};
  EXPECT_NEAR(greedy_gap(trap, {1000, kNoLimit}), 0.99, 0.001);
}

TEST(BestChoice, TakesTheLayerThatACrumbKeepsOut) {
  const std::vector<Candidate> trap = {{0, 1.01, {10}}, {1, 100, {1000}}};
  EXPECT_THAT(greedy_choice(trap, {1000, kNoLimit}).layers, ElementsAre(0));
  EXPECT_THAT(best_choice(trap, {1000, kNoLimit}).layers, ElementsAre(1));
  EXPECT_THAT(best_choice({}, {1000, kNoLimit}).layers, ElementsAre());
}

// By its definition: never worse than greedy, within the budget, and at least 1 / (2 k) of the best by brute force
// with k kinds of budget; one half with one.
TEST(BestChoice, IsSafeAgainstExhaustiveSearch) {
  constexpr unsigned kSeed = 2026;
  std::mt19937 random(kSeed);
  double worst_of_best = 1, worst_of_greedy = 1;
  for (int trial = 0; trial < 150; ++trial) {
    auto candidates = random_candidates(random, trial % 12);
    if (trial % 3 == 0 && !candidates.empty())
      candidates[0].benefit_px *= 100;  // one that outweighs the rest
    for (const auto& [budget, kinds] :
         {std::pair{Budget{1000, kNoLimit}, 1}, std::pair{Budget{kNoLimit, 50'000}, 1},
          std::pair{Budget{1000, 50'000}, 2}, std::pair{Budget{1500, 60'000, 30}, 3},
          std::pair{Budget{0, 0}, 2}, std::pair{Budget{}, 1}}) {
      const Choice best = best_choice(candidates, budget), greedy = greedy_choice(candidates, budget);
      const double optimum = best_by_brute_force(candidates, budget);
      LayerCost spent;
      for (const int layer : best.layers) {
        spent.polygons += candidates[layer].cost.polygons;
        spent.pixels += candidates[layer].cost.pixels;
        spent.chunks += candidates[layer].cost.chunks;
      }
      EXPECT_TRUE(budget.affords(spent)) << "seed " << kSeed << " trial " << trial;
      EXPECT_GE(best.benefit_px, greedy.benefit_px) << "seed " << kSeed << " trial " << trial;
      EXPECT_GE(best.benefit_px * 2 * kinds * (1 + 1e-9), optimum) << "seed " << kSeed << " trial " << trial;
      if (!(optimum > 0)) continue;
      worst_of_best = std::min(worst_of_best, best.benefit_px / optimum);
      worst_of_greedy = std::min(worst_of_greedy, greedy.benefit_px / optimum);
    }
  }
  std::printf("least share of the best benefit: best %.3f, paper %.3f\n", worst_of_best, worst_of_greedy);
}

TEST(PolicyBudget, BestChoiceIsDrawnAndItsReasonsSayWhatIsLacking) {
  RegulatorOptions options = budget_of(1000);
  options.budget.choice = ChoiceRule::Best;
  const auto decisions = decide({layer_of(0, 1.01, 10), layer_of(1, 100, 1000)}, options);
  EXPECT_THAT(rendered(decisions), ElementsAre(1));
  EXPECT_THAT(decisions[0].reason, HasSubstr("deferred: budget, polygons 10 > 0 left of 1000"));
  EXPECT_TRUE(decisions[0].deferred);
  EXPECT_FALSE(decisions[0].over_budget);
}

TEST(PolicyBudget, LayerDearerThanTheWholeBudgetIsMarked) {
  const auto decisions = decide({layer_of(0, 9, 5000)}, budget_of(1000));
  EXPECT_TRUE(decisions[0].over_budget);
  EXPECT_THAT(decisions[0].reason, HasSubstr("dearer than the whole budget of 1000 polygons, needs 5000"));
}

TEST(FrameBudget, DepthComplexityDividesThePixelsOfTheTimeAlone) {
  RegulatorOptions options;
  options.budget.ms = 10;
  options.budget.pixels = 300'000;
  options.budget.depth_complexity = 1;
  EXPECT_EQ(frame_budget(options).pixels, 300'000);  // 10 ms are 400,000
  options.budget.depth_complexity = 2;
  EXPECT_EQ(frame_budget(options).pixels, 200'000);
  EXPECT_EQ(frame_budget(options).polygons, 15'000);
}

TEST(GreedyChoice, IsWhatThePolicyDraws) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> error(0, 5);
  std::uniform_int_distribution<std::int64_t> cost(0, 1000);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<LayerAssessment> layers;
    for (int i = 0; i < 20; ++i) layers.push_back(layer_of(i, error(random), cost(random), cost(random)));
    layers[3].has_sprite = false;
    const RegulatorOptions options = budget_of(3000, 3000);
    std::vector<int> expected =
        greedy_choice(candidates_of(layers, options), left_after_first_appearances(layers, options)).layers;
    expected.insert(std::lower_bound(expected.begin(), expected.end(), 3), 3);
    std::vector<LayerDecision> decisions = decide(layers, options);
    EXPECT_EQ(rendered(decisions), expected) << "seed " << kSeed << " trial " << trial;
    LayerCost spent;
    for (const LayerDecision& d : decisions) spent.polygons += d.cost.polygons, spent.pixels += d.cost.pixels;
    EXPECT_LE(spent.polygons, 3000);
    EXPECT_LE(spent.pixels, 3000);
  }
}

}  // namespace
}  // namespace talisman::regulator
