// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/solver.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"

namespace talisman::regulator {
namespace {

constexpr double kUnits_per_ms = 1e9;
constexpr double kNoBudgetLimit = 4e18;

/// Rounded up, so that what is chosen never costs more than it may.
std::int64_t whole_cost(double cost_ms) {
  const double units = std::ceil(std::max(cost_ms, 0.0) * kUnits_per_ms);
  return units < static_cast<double>(kNeverTaken) ? static_cast<std::int64_t>(units) : kNeverTaken;
}

std::int64_t whole_budget(double budget_ms) {
  const double units = std::floor(budget_ms * kUnits_per_ms);
  return units >= 0 ? static_cast<std::int64_t>(std::min(units, kNoBudgetLimit)) : 0;
}

/// Of each layer: of least cost, of these of most benefit, of these the first.
std::vector<int> cheapest_of(const WholeProblem& whole) {
  std::vector<int> result;
  for (int layer = 0; layer < whole.layers(); ++layer) {
    int best = whole.first[static_cast<std::size_t>(layer)];
    for (int k = best + 1; k < whole.first[static_cast<std::size_t>(layer) + 1]; ++k) {
      const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>(best);
      if (whole.costs[a] < whole.costs[b] ||
          (whole.costs[a] == whole.costs[b] && whole.benefits[a] > whole.benefits[b]))
        best = k;
    }
    result.push_back(best);
  }
  return result;
}

/// Middle of the first, the middle and the last.
template <typename T>
double middle_slope(const std::vector<T>& steps) {
  const double a = steps.front().slope, b = steps[steps.size() / 2].slope, c = steps.back().slope;
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

}  // namespace

void LodProblem::add(std::span<const LodChoice> of_layer) {
  TALISMAN_CHECK(!of_layer.empty());
  choices.insert(choices.end(), of_layer.begin(), of_layer.end());
  first.push_back(static_cast<int>(choices.size()));
}

/// The steps of a layer from its cheapest choice, their slopes falling. A choice that cannot be had even where all
/// others are at their cheapest is left out.
void LodSolver::add_hull(int layer, std::int64_t slack) {
  const auto base = static_cast<std::size_t>(cheapest_.at[static_cast<std::size_t>(layer)]);
  std::vector<int>& order = order_;
  order.clear();
  for (int k = whole_.first[static_cast<std::size_t>(layer)];
       k < whole_.first[static_cast<std::size_t>(layer) + 1]; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (whole_.costs[at] < kNeverTaken && whole_.benefits[at] > whole_.benefits[base] &&
        whole_.costs[at] - whole_.costs[base] <= slack)
      order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [this](int a, int b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    if (whole_.costs[i] != whole_.costs[j]) return whole_.costs[i] < whole_.costs[j];
    if (whole_.benefits[i] != whole_.benefits[j]) return whole_.benefits[i] > whole_.benefits[j];
    return a < b;
  });
  const std::size_t begin = steps_.size();
  for (const int k : order) {
    const auto to = static_cast<std::size_t>(k);
    for (;;) {
      const bool is_first = steps_.size() == begin;
      const auto from = is_first ? base : static_cast<std::size_t>(steps_.back().to);
      if (!(whole_.benefits[to] > whole_.benefits[from])) break;
      const std::int64_t cost = whole_.costs[to] - whole_.costs[from];
      const double slope = (whole_.benefits[to] - whole_.benefits[from]) / static_cast<double>(cost);
      if (is_first || slope < steps_.back().slope) {
        steps_.push_back({slope, cost, k});
        break;
      }
      steps_.pop_back();
    }
  }
}

void LodSolver::rebuild(const LodProblem& problem) {
  whole_.costs.clear();
  whole_.benefits.clear();
  whole_.costs.reserve(problem.choices.size());
  whole_.benefits.reserve(problem.choices.size());
  steps_.reserve(problem.choices.size());
  for (const LodChoice& choice : problem.choices) {
    whole_.costs.push_back(std::isnan(choice.cost_ms) ? kNeverTaken : whole_cost(choice.cost_ms));
    whole_.benefits.push_back(choice.benefit > 0 ? choice.benefit : 0);
  }
  whole_.first = problem.first;
  whole_.budget = whole_budget(problem.budget_ms);
  cheapest_ = priced(whole_, cheapest_of(whole_));
  steps_.clear();
  first_step_.assign(1, 0);
  for (int layer = 0; layer < whole_.layers(); ++layer) {
    add_hull(layer, whole_.budget - cheapest_.cost);
    first_step_.push_back(static_cast<int>(steps_.size()));
  }
  last_ = problem;
  has_last_ = true;
}

LodSolver::Break LodSolver::find_break(std::int64_t slack) const {
  Break found;
  std::vector<Step> left, next;
  double pivot = last_slope_;
  for (bool is_first = true; is_first || !left.empty(); is_first = false) {
    const std::vector<Step>& among = is_first ? steps_ : left;
    if (!is_first) pivot = middle_slope(left);
    ++found.iterations;
    std::int64_t steeper = 0, equal = 0;
    for (const Step& step : among) {
      steeper += step.slope > pivot ? step.cost : 0;
      equal += step.slope == pivot ? step.cost : 0;
    }
    const bool too_flat = steeper > slack - found.steeper_cost;  // the break is among the steeper ones
    if (!too_flat) {
      found.steeper_cost += steeper;
      if (equal > slack - found.steeper_cost) {
        found.slope = pivot;
        return found;
      }
      found.steeper_cost += equal;
    }
    next.clear();
    for (const Step& step : among)
      if (too_flat ? step.slope > pivot : step.slope < pivot) next.push_back(step);
    left.swap(next);
  }
  return found;
}

/// All steps that are steeper, and of those of its slope what fits, in the order of the layers.
Picked LodSolver::greedy(const Break& where, int& first_left_out) const {
  Picked picked = cheapest_;
  first_left_out = -1;
  std::int64_t left = whole_.budget - cheapest_.cost - where.steeper_cost;
  for (int layer = 0; layer < whole_.layers(); ++layer)
    for (int s = first_step_[static_cast<std::size_t>(layer)];
         s < first_step_[static_cast<std::size_t>(layer) + 1]; ++s) {
      const Step& step = steps_[static_cast<std::size_t>(s)];
      if (step.slope < where.slope) break;
      if (step.slope == where.slope) {
        if (step.cost > left) {
          if (first_left_out < 0) first_left_out = step.to;
          break;
        }
        left -= step.cost;
      }
      picked.at[static_cast<std::size_t>(layer)] = step.to;
    }
  return priced(whole_, std::move(picked.at));
}

LodSolution LodSolver::solve(const LodProblem& problem) {
  const bool unchanged = has_last_ && problem.budget_ms == last_.budget_ms && problem.first == last_.first &&
                         problem.choices == last_.choices;
  if (!unchanged) rebuild(problem);
  LodSolution solution;
  solution.fits = cheapest_.cost <= whole_.budget;
  Picked picked = cheapest_;
  solution.upper_bound = cheapest_.benefit;
  if (solution.fits) {
    const Break where = find_break(whole_.budget - cheapest_.cost);
    last_slope_ = where.slope;
    solution.iterations = where.iterations;
    int left_out = -1;
    picked = greedy(where, left_out);
    // Dantzig: the steps of the break's slope are as good as one that is divisible.
    solution.upper_bound =
        picked.benefit + std::max(0.0, where.slope) * static_cast<double>(whole_.budget - picked.cost);
    picked = filled(whole_, std::move(picked));
    if (picked.benefit < kNearEnough * solution.upper_bound && left_out >= 0)
      picked = improved(std::move(picked), left_out, solution.upper_bound);
  }
  for (int layer = 0; layer < whole_.layers(); ++layer)
    solution.chosen.push_back(picked.at[static_cast<std::size_t>(layer)] -
                              whole_.first[static_cast<std::size_t>(layer)]);
  solution.cost_ms = static_cast<double>(picked.cost) / kUnits_per_ms;
  solution.benefit = picked.benefit;
  solution.upper_bound = std::max(solution.upper_bound, picked.benefit);
  return solution;
}

/// Step 4.
Picked LodSolver::improved(Picked picked, int left_out, double upper_bound) const {
  const auto layer = std::upper_bound(whole_.first.begin(), whole_.first.end(), left_out) - 1;
  Picked alone = cheapest_;
  alone.at[static_cast<std::size_t>(layer - whole_.first.begin())] = left_out;
  alone = filled(whole_, priced(whole_, std::move(alone.at)));
  if (alone.benefit > picked.benefit) picked = std::move(alone);
  if (static_cast<int>(whole_.costs.size()) > kSmallProblem) return picked;
  return exchanged(whole_, std::move(picked), kNearEnough * upper_bound);
}

LodSolution solve(const LodProblem& problem) { return LodSolver().solve(problem); }

}  // namespace talisman::regulator
