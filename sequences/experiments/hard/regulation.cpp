// SPDX-License-Identifier: Apache-2.0
// The regulator: all choices by trial, schedules by dynamic programming, and rules that a frame must keep.
#include <algorithm>
#include <cmath>
#include <limits>

#include "regulator/budget.h"
#include "regulator/profile.h"
#include "regulator/resolution.h"
#include "regulator/schedule.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"

namespace talisman::sequences {
namespace {

using regulator::Budget;
using regulator::Candidate;
using regulator::LayerAssessment;
using regulator::RegulatorOptions;

struct ChoiceProblem {
  std::vector<Candidate> candidates;
  Budget budget;
};

/// 14 layers whose benefits and costs lie in these ranges, and a budget of about a third of all.
ChoiceProblem random_problem(std::uint64_t seed, double least_px, double most_px, double least_cost,
                             double most_cost, bool all_limits) {
  Random random(seed);
  ChoiceProblem problem;
  regulator::LayerCost sum;
  for (int layer = 0; layer < 14; ++layer) {
    Candidate c;
    c.layer = layer;
    c.benefit_px = random.log_uniform(least_px, most_px);
    c.cost.polygons = std::int64_t(random.log_uniform(least_cost, most_cost));
    c.cost.pixels = std::int64_t(random.log_uniform(least_cost, most_cost));
    c.cost.chunks = 1 + c.cost.pixels / 1024;
    sum.polygons += c.cost.polygons, sum.pixels += c.cost.pixels, sum.chunks += c.cost.chunks;
    problem.candidates.push_back(c);
  }
  problem.budget.polygons = sum.polygons / 3;
  if (all_limits) problem.budget.pixels = sum.pixels / 3, problem.budget.chunks = sum.chunks / 4;
  return problem;
}

long double benefit_of(const ChoiceProblem& problem, const std::vector<int>& layers) {
  long double sum = 0;
  for (const int layer : layers) sum += problem.candidates[layer].benefit_px;
  return sum;
}

bool within_budget(const ChoiceProblem& problem, const std::vector<int>& layers) {
  __int128 polygons = 0, pixels = 0, chunks = 0;
  for (const int layer : layers) {
    const regulator::LayerCost& cost = problem.candidates[layer].cost;
    polygons += cost.polygons, pixels += cost.pixels, chunks += cost.chunks;
  }
  return polygons <= problem.budget.polygons && pixels <= problem.budget.pixels &&
         chunks <= problem.budget.chunks;
}

long double best_by_trial(const ChoiceProblem& problem) {
  long double best = 0;
  for (unsigned subset = 0; subset < 1u << problem.candidates.size(); ++subset) {
    std::vector<int> layers;
    for (std::size_t i = 0; i < problem.candidates.size(); ++i)
      if (subset >> i & 1) layers.push_back(int(i));
    if (within_budget(problem, layers)) best = std::max(best, benefit_of(problem, layers));
  }
  return best;
}

/// What the best choice misses of the best of all subsets, relative; a choice beyond the budget counts 1.
HardOutcome best_choice(const std::function<ChoiceProblem(std::uint64_t)>& problem_of) {
  long double worst = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const ChoiceProblem problem = problem_of(seed);
    const regulator::Choice choice = regulator::optimal_choice(problem.candidates, problem.budget);
    const long double best = best_by_trial(problem), got = benefit_of(problem, choice.layers);
    if (!within_budget(problem, choice.layers)) return {1, false};
    worst = worse(worst, best > 0 ? (best - got) / best : got);
  }
  return {double(worst), false};
}

/// The share of 300 frames in which the greedy choice spends more than there is, or more benefit than the best.
HardOutcome greedy_choice_keeps_budget(double least_cost, double most_cost) {
  double wrong = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const ChoiceProblem problem = random_problem(seed, 1e-6, 1e6, least_cost, most_cost, seed % 2 == 0);
    wrong += !within_budget(problem, regulator::greedy_choice(problem.candidates, problem.budget).layers);
  }
  return {wrong / 300, false};
}

void add_choices(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, double low, double high,
                       double cheap, double dear, bool all) {
    cases.push_back(
        {HardStage::Regulator, name, special, extreme, {1e-12, "of the benefit", "all 16,384 subsets"}, [=] {
           return best_choice(
               [=](std::uint64_t seed) { return random_problem(seed, low, high, cheap, dear, all); });
         }});
  };
  add("best of 14 layers", "one limit", 1, 0.1, 10, 100, 1e4, false);
  add("best, three limits", "polygons, pixels and chunks", 1, 0.1, 10, 100, 1e4, true);
  add("benefits 1e-6 ... 1e6 px", "one layer gains more than all others", 1e12, 1e-6, 1e6, 100, 1e4, true);
  add("costs 1 ... 1e12", "one layer costs more than all others", 1e12, 0.1, 10, 1, 1e12, true);
  cases.push_back({HardStage::Regulator,
                   "nothing may be spent",
                   "a budget of 0",
                   1,
                   {0, "of the benefit", "all 16,384 subsets"},
                   [] {
                     return best_choice([](std::uint64_t seed) {
                       ChoiceProblem problem = random_problem(seed, 0.1, 10, 100, 1e4, true);
                       problem.budget = {0, 0, 0};
                       return problem;
                     });
                   }});
  for (const double dear : {1e4, 1e15})
    cases.push_back({HardStage::Regulator,
                     dear < 1e5 ? "greedy, 300 frames" : "greedy, costs to 1e15",
                     "never more than the budget",
                     dear,
                     {0, "of the frames", "128-bit sums"},
                     [dear] { return greedy_choice_keeps_budget(1, dear); }});
}

// --- Thresholds

LayerAssessment assessed_layer(double error_px) {
  LayerAssessment layer;
  layer.layer = 0;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 5;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fiducials.geometric.px = layer.held_geometric_px = error_px;
  layer.cost = {100, 1000, 1, 4096};
  return layer;
}

bool drawn_again(const LayerAssessment& layer, double threshold_px) {
  RegulatorOptions options;
  options.thresholds.geometric_px = threshold_px;
  return regulator::regulate(9, {&layer, 1}, options).decisions.at(0).action == regulator::Action::Rerender;
}

/// At the threshold itself a layer is kept, one ulp above it is drawn: wrong decisions over thresholds of 18 orders.
HardOutcome at_the_threshold() {
  int wrong = 0;
  for (double threshold = 1e-9; threshold < 1e9; threshold *= 7) {
    wrong += drawn_again(assessed_layer(threshold), threshold);
    wrong += !drawn_again(assessed_layer(std::nextafter(threshold, HUGE_VAL)), threshold);
  }
  return {double(wrong), false};
}

HardOutcome without_a_meaning() {
  int wrong = 0;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), warp::kHugePx, HUGE_VAL}) {
    wrong += !drawn_again(assessed_layer(bad), 1e9);
    wrong += regulator::benefit_px(assessed_layer(bad)) != regulator::kMostBenefitPx;
  }
  return {double(wrong), false};
}

/// A budget in ms is one of polygons and one of pixels: at its very edge, over 12 orders of time, what fits takes no longer,
/// and one polygon or pixel more takes longer.
HardOutcome milliseconds_as_counts() {
  int wrong = 0;
  for (double ms = 1e-3; ms < 1e9; ms *= 3.7) {
    RegulatorOptions options;
    options.policy = regulator::Policy::Budget;
    options.budget.ms = ms;
    const Budget budget = regulator::frame_budget(options);
    const auto& profile = regulator::talisman_1996();
    const auto takes = [&](std::int64_t polygons, std::int64_t pixels) -> long double {
      return 1000 * std::max((long double)polygons / profile.polygons_per_s,
                             (long double)pixels / profile.renderer_pixels_per_s);
    };
    const long double rounding = 1 + 1e-12L;
    wrong += takes(budget.polygons, budget.pixels) > ms * rounding;
    wrong += takes(budget.polygons + 1, 0) * rounding <= ms;
    wrong += takes(0, budget.pixels + 1) * rounding <= ms;
  }
  return {double(wrong), false};
}

/// Layers of 1 … 1e9 pixels and a budget of a part of them: by how much what is drawn at the share of resolution exceeds
/// the budget, relative.
HardOutcome resolution_fits_budget(double pixels) {
  std::vector<LayerAssessment> layers;
  long double desired = 0;
  for (int i = 0; i < 20; ++i) {
    LayerAssessment layer = assessed_layer(5);
    layer.layer = i;
    layer.has_sprite = false;
    layer.cost.pixels = std::int64_t(pixels * (i + 1));
    desired += layer.cost.pixels;
    layers.push_back(layer);
  }
  RegulatorOptions options;
  options.policy = regulator::Policy::Budget;
  options.budget.pixels = std::int64_t(desired / 7);
  const long double s = regulator::share_of_resolution(layers, options);
  return {double(std::fabs(desired * s * s / options.budget.pixels - 1)), false};
}

// --- Schedules

/// Runs are compared with the fewest of a dynamic program over all cuts and all instants; 60 predicates without any order.
HardOutcome fewest_runs(int frames, double share_served) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    std::vector<std::vector<bool>> serves(frames, std::vector<bool>(frames));
    for (int r = 0; r < frames; ++r)
      for (int f = 0; f < frames; ++f) serves[r][f] = r == f || random.uniform(0, 1) < share_served;
    std::vector<int> fewest(frames + 1, frames + 1);
    fewest[0] = 0;
    for (int first = 0; first < frames; ++first)
      for (int r = 0; r < frames; ++r)
        for (int f = first; f < frames && serves[r][f]; ++f)
          fewest[f + 1] = std::min(fewest[f + 1], fewest[first] + 1);
    const auto runs =
        regulator::fewest_renders(0, frames - 1, [&](int r, int f) { return bool(serves[r][f]); });
    wrong += int(runs.size()) != fewest[frames];
  }
  return {double(wrong), false};
}

void add_rules(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, HardRule rule,
                       std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Regulator, name, special, extreme, rule, std::move(measure)});
  };
  add("one ulp above", "thresholds 1e-9 ... 1e9 px, hit exactly", 1e18, {0, "decisions", "definition"},
      at_the_threshold);
  add("errors without a meaning", "not a number, infinite, 1e30 px", 1e30, {0, "decisions", "definition"},
      without_a_meaning);
  add("ms as counts", "budgets 1e-3 ... 1e9 ms, one polygon more", 1e12,
      {0, "budgets", "modelled time, long double"}, milliseconds_as_counts);
  add("resolution, 1e3 px", "20 layers, a seventh of their pixels", 1e3,
      {1e-5, "of the budget", "sum, long double"}, [] { return resolution_fits_budget(1e3); });
  add("resolution, 1e12 px", "20 layers, a seventh of their pixels", 1e12,
      {1e-5, "of the budget", "sum, long double"}, [] { return resolution_fits_budget(1e12); });
  add("schedules of 40 frames", "what serves which is drawn by lot", 40, {0, "schedules", "dynamic program"},
      [] { return fewest_runs(40, 0.8); });
  add("schedules, nothing serves", "every frame for itself", 1, {0, "schedules", "dynamic program"},
      [] { return fewest_runs(25, 0); });
}

}  // namespace

std::vector<HardCase> hard_regulation() {
  std::vector<HardCase> cases;
  add_choices(cases);
  add_rules(cases);
  return cases;
}

}  // namespace talisman::sequences
