// SPDX-License-Identifier: Apache-2.0
// Against every choice there is, and against the branch and cut of GLPK.
#include "regulator/lod/solver.h"

#include <glpk.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

LodProblem problem_of(std::vector<std::vector<LodChoice>> layers, double budget_ms) {
  LodProblem problem;
  for (const auto& layer : layers) problem.add(layer);
  problem.budget_ms = budget_ms;
  return problem;
}

double cost_of(const LodProblem& problem, const std::vector<int>& chosen) {
  double cost = 0;
  for (int i = 0; i < problem.layers(); ++i)
    cost += problem
                .choices[static_cast<std::size_t>(problem.first[static_cast<std::size_t>(i)] +
                                                  chosen[static_cast<std::size_t>(i)])]
                .cost_ms;
  return cost;
}

/// The most benefit by trying all; negative: nothing fits.
double best_of_all(const LodProblem& problem, int layer = 0, double cost = 0) {
  if (layer == problem.layers()) return cost <= problem.budget_ms ? 0 : -HUGE_VAL;
  double best = -HUGE_VAL;
  for (int k = problem.first[static_cast<std::size_t>(layer)];
       k < problem.first[static_cast<std::size_t>(layer) + 1]; ++k) {
    const LodChoice& choice = problem.choices[static_cast<std::size_t>(k)];
    best = std::max(best, choice.benefit + best_of_all(problem, layer + 1, cost + choice.cost_ms));
  }
  return best;
}

/// To this share of it: the last digits take long where ratios are equal.
double best_of_glpk(const LodProblem& problem, double gap) {
  glp_term_out(GLP_OFF);
  glp_prob* program = glp_create_prob();
  glp_set_obj_dir(program, GLP_MAX);
  const int rows = problem.layers() + 1, columns = static_cast<int>(problem.choices.size());
  glp_add_rows(program, rows);
  glp_add_cols(program, columns);
  glp_set_row_bnds(program, 1, GLP_UP, 0, problem.budget_ms);
  for (int i = 0; i < problem.layers(); ++i) {
    glp_set_row_bnds(program, i + 2, GLP_FX, 1, 1);
    for (int k = problem.first[static_cast<std::size_t>(i)];
         k < problem.first[static_cast<std::size_t>(i) + 1]; ++k) {
      const LodChoice& choice = problem.choices[static_cast<std::size_t>(k)];
      glp_set_col_kind(program, k + 1, GLP_BV);
      glp_set_obj_coef(program, k + 1, choice.benefit);
      const int at[] = {0, 1, i + 2};
      const double values[] = {0, choice.cost_ms, 1};
      glp_set_mat_col(program, k + 1, 2, at, values);
    }
  }
  glp_iocp options;
  glp_init_iocp(&options);
  options.presolve = GLP_ON;
  options.msg_lev = GLP_MSG_OFF;
  options.mip_gap = gap;
  const int failed = glp_intopt(program, &options);
  const double best = failed == 0 || failed == GLP_EMIPGAP ? glp_mip_obj_val(program)
                                                           : std::numeric_limits<double>::quiet_NaN();
  glp_delete_prob(program);
  return best;
}

/// Kinds of instances, by number: ordinary layers, few large ones, equal ratios, the counter-example among others, levels
/// that rise in no order.
LodProblem random_problem(std::mt19937& random, int kind, int layers, int choices) {
  std::uniform_real_distribution<double> uniform;
  LodProblem problem;
  double all = 0, least = 0;
  for (int i = 0; i < layers; ++i) {
    const bool is_large = kind == 1 && uniform(random) < 0.2;
    const double cost = (is_large ? 40 : 1) * (0.05 + uniform(random)),
                 worth = cost * (0.2 + uniform(random));
    std::vector<LodChoice> of_layer = {{0, 0}};
    for (int k = 1; k < choices; ++k) {
      const double t = static_cast<double>(k) / (choices - 1);
      if (kind == 2)
        of_layer.push_back({cost * t, cost * t});
      else if (kind == 4)
        of_layer.push_back({cost * uniform(random), worth * uniform(random)});
      else
        of_layer.push_back({cost * std::pow(2, k - choices + 1), worth * std::pow(t, 0.3 + uniform(random))});
    }
    if (kind == 3 && i == 0) of_layer = {{0, 0}, {1, 2}};
    if (kind == 3 && i == 1) of_layer = {{0, 0}, {100, 100}};
    if (kind == 3 && i > 1)
      for (LodChoice& c : of_layer) c.benefit *= 0.01;
    double dearest = 0;
    for (const LodChoice& c : of_layer) dearest = std::max(dearest, c.cost_ms);
    all += dearest;
    least += of_layer[0].cost_ms;
    problem.add(of_layer);
  }
  problem.budget_ms = kind == 3 ? 100 : least + (all - least) * uniform(random) * 0.8;
  return problem;
}

void expect_kept(const LodProblem& problem, const LodSolution& solution) {
  ASSERT_EQ(solution.chosen.size(), static_cast<std::size_t>(problem.layers()));
  EXPECT_TRUE(solution.fits);
  EXPECT_LE(cost_of(problem, solution.chosen), problem.budget_ms * (1 + 1e-12) + 1e-12);
  EXPECT_LE(solution.benefit, solution.upper_bound);
}

TEST(LodSolver, TakesTheLargeItemWhereASmallOneWithTheBetterRatioShutsItOut) {
  const LodProblem problem = problem_of({{{0, 0}, {1, 2}}, {{0, 0}, {100, 100}}}, 100);
  const LodSolution solution = solve(problem);
  EXPECT_EQ(solution.chosen, (std::vector{0, 1}));
  EXPECT_EQ(solution.benefit, 100);
  EXPECT_NEAR(solution.upper_bound, 2 + 99, 1e-9);
}

TEST(LodSolver, FollowsTheMarginalBenefitNotTheTotal) {
  // By total value the second level of a (11 / 2) comes before the first of b (5 / 1), though it adds 1 for 1.
  const LodSolution solution = solve(problem_of({{{0, 0}, {1, 10}, {2, 11}}, {{0, 0}, {1, 5}}}, 2));
  EXPECT_EQ(solution.chosen, (std::vector{1, 1}));
}

TEST(LodSolver, FillsWhatIsLeftWithChoicesBesideTheHull) {
  // The hull of a goes from 0 to (10, 100); of what is left after b, 4, (4, 10) is all that fits.
  const LodSolution solution = solve(problem_of({{{0, 0}, {4, 10}, {10, 100}}, {{0, 0}, {6, 300}}}, 10));
  EXPECT_EQ(solution.chosen, (std::vector{1, 1}));
}

/// Shares of the best that are reached.
class Shares {
 public:
  /// `best` by another way, known up to `tolerance` of it.
  void check(const LodProblem& problem, double best, double tolerance) {
    const LodSolution solution = solve(problem);
    expect_kept(problem, solution);
    ASSERT_FALSE(std::isnan(best));
    EXPECT_LE(best, solution.upper_bound * (1 + tolerance) + 1e-9);
    if (best <= 0) return;
    sum_ += solution.benefit / best;
    worst_ = std::min(worst_, solution.benefit / best);
    ++count_;
  }
  void expect(double mean) const {
    EXPECT_GE(sum_ / count_, mean);
    EXPECT_GE(worst_, 0.5);
    testing::Test::RecordProperty("mean", std::to_string(sum_ / count_));
    testing::Test::RecordProperty("worst", std::to_string(worst_));
  }

 private:
  double sum_ = 0, worst_ = 1;
  int count_ = 0;
};

TEST(LodSolver, IsNearTheBestOfAllSmallInstancesAndNeverBelowHalf) {
  std::mt19937 random(1);
  Shares shares;
  for (int trial = 0; trial < 2000; ++trial) {
    const int layers = 2 + static_cast<int>(random() % 5), choices = 2 + static_cast<int>(random() % 3);
    const LodProblem problem = random_problem(random, trial % 5, layers, choices);
    const double best = best_of_all(problem);
    EXPECT_LE(solve(problem).benefit, best * (1 + 1e-9) + 1e-12) << trial;
    shares.check(problem, best, 1e-12);
  }
  shares.expect(0.99);
}

TEST(LodSolver, IsNearTheOptimumOfGlpkOnAThousandInstances) {
  std::mt19937 random(2);
  Shares shares;
  for (int trial = 0; trial < 1000; ++trial) {
    const int layers = 4 + static_cast<int>(random() % 30), choices = 2 + static_cast<int>(random() % 4);
    const LodProblem problem = random_problem(random, trial % 5, layers, choices);
    shares.check(problem, best_of_glpk(problem, trial % 5 == 2 ? 1e-3 : 1e-4), 1e-5);
  }
  shares.expect(0.97);
}

/// In large frames nothing is tried: the first pass alone has to be near the bound.
TEST(LodSolver, LargeFramesAreNearTheirBound) {
  std::mt19937 random(3);
  for (int kind = 0; kind < 5; ++kind) {
    const LodProblem problem = random_problem(random, kind, 1000, 5);
    const LodSolution solution = solve(problem);
    expect_kept(problem, solution);
    EXPECT_GE(solution.benefit, (kind == 3 ? 0.5 : 0.97) * solution.upper_bound) << kind;
  }
}

TEST(LodSolver, AnUnchangedFrameTakesOneIteration) {
  std::mt19937 random(4);
  const LodProblem problem = random_problem(random, 0, 1000, 5);
  LodSolver solver;
  const LodSolution cold = solver.solve(problem), warm = solver.solve(problem);
  EXPECT_GT(cold.iterations, 1);
  EXPECT_EQ(warm.iterations, 1);
  EXPECT_EQ(warm.chosen, cold.chosen);
}

TEST(LodSolver, WhatWasSolvedBeforeNeverChangesTheAnswer) {
  std::mt19937 random(6);
  LodSolver warm;
  LodProblem problem = random_problem(random, 0, 60, 5);
  for (int frame = 0; frame < 300; ++frame) {
    if (frame % 50 == 49) problem = random_problem(random, frame % 5, 60, 5);  // a cut
    for (int k = 0; k < 5; ++k) {
      LodChoice& choice = problem.choices[random() % problem.choices.size()];
      if (choice.cost_ms > 0) choice.benefit *= 0.9 + 0.2 * static_cast<double>(random() % 100) / 100;
    }
    problem.budget_ms *= frame % 7 == 0 ? 1.1 : 0.99;
    const LodSolution a = warm.solve(problem), b = solve(problem);
    ASSERT_EQ(a.chosen, b.chosen) << frame;
    EXPECT_EQ(a.benefit, b.benefit);
    EXPECT_EQ(a.cost_ms, b.cost_ms);
    EXPECT_EQ(a.upper_bound, b.upper_bound);
  }
}

TEST(LodSolver, ZeroBudgetShowsTheCheapest) {
  const LodSolution free = solve(problem_of({{{0, 1}, {1, 2}}, {{0.5, 3}, {0, 0}}}, 0));
  EXPECT_TRUE(free.fits);
  EXPECT_EQ(free.chosen, (std::vector{0, 1}));
  const LodSolution dear = solve(problem_of({{{1, 1}, {2, 5}}, {{0.5, 3}}}, 0));
  EXPECT_FALSE(dear.fits);
  EXPECT_EQ(dear.chosen, (std::vector{0, 0}));
  EXPECT_DOUBLE_EQ(dear.cost_ms, 1.5);
}

TEST(LodSolver, WithoutALimitTheBestOfEachIsTaken) {
  const LodSolution solution =
      solve(problem_of({{{1, 1}, {2, 5}, {3, 4}}, {{0, 0}, {HUGE_VAL, 100}}}, HUGE_VAL));
  EXPECT_EQ(solution.chosen, (std::vector{1, 0}));
  EXPECT_TRUE(solution.fits);
  EXPECT_EQ(solution.upper_bound, solution.benefit);
}

TEST(LodSolver, EqualAndZeroBenefitsAndCostsAreDecidedTheSameWayAlways) {
  EXPECT_EQ(solve(problem_of({{{1, 0}, {2, 0}}, {{3, 0}, {1, 0}}}, 10)).chosen, (std::vector{0, 1}));
  EXPECT_EQ(solve(problem_of({{{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}}, 2)).chosen,
            (std::vector{1, 1, 0}));
  EXPECT_EQ(solve(problem_of({{{1, 2}, {1, 3}, {1, 3}}}, 5)).chosen, (std::vector{1}));
  EXPECT_EQ(solve(problem_of({{{0, 0}, {0, 7}}}, 0)).chosen, (std::vector{1}));
}

TEST(LodSolver, WhatIsNoNumberCostsMoreThanThereIsAndGivesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LodSolution solution = solve(problem_of({{{0, 0}, {nan, 50}, {1, nan}, {2, 1}}}, 10));
  EXPECT_EQ(solution.chosen, (std::vector{3}));
  EXPECT_EQ(solve(problem_of({{{1, 1}, {2, 2}}}, nan)).chosen, (std::vector{0}));
  EXPECT_FALSE(solve(problem_of({{{nan, 1}}}, 10)).fits);
}

TEST(LodSolver, NothingToChooseFromIsASolution) {
  const LodSolution solution = solve(LodProblem{});
  EXPECT_TRUE(solution.fits);
  EXPECT_TRUE(solution.chosen.empty());
  EXPECT_EQ(solution.benefit, 0);
}

}  // namespace
}  // namespace talisman::regulator
