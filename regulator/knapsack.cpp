// SPDX-License-Identifier: Apache-2.0
// The choice of step 7 as a knapsack: greedy, and the best there is. See regulator/budget.h.
#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "regulator/budget.h"

namespace talisman::regulator {

namespace {

/// A choice of some of the candidates that no other choice beats in all numbers. What is not limited is 0.
struct State {
  LayerCost spent;
  double benefit_px = 0;
  int parent = -1;  ///< index into the history; -1: nothing chosen
  int candidate = -1;
};

bool costs_no_more(const LayerCost& a, const LayerCost& b) {
  return a.polygons <= b.polygons && a.pixels <= b.pixels && a.chunks <= b.chunks;
}

/// Cheapest first; the dearer of two states can never beat the cheaper.
bool is_before(const State& a, const State& b) {
  if (a.spent.polygons != b.spent.polygons) return a.spent.polygons < b.spent.polygons;
  if (a.spent.pixels != b.spent.pixels) return a.spent.pixels < b.spent.pixels;
  if (a.spent.chunks != b.spent.chunks) return a.spent.chunks < b.spent.chunks;
  return a.benefit_px > b.benefit_px;
}

/// States before a state, in order, with which it is compared. Those nearest in cost beat it if any does; to
/// look further costs time in proportion and may only spare states, it never changes the answer.
constexpr std::ptrdiff_t kCompared = 128;

/// Drops states that another one beats.
std::vector<State> unbeaten(std::vector<State> states) {
  std::stable_sort(states.begin(), states.end(), is_before);
  std::vector<State> kept;
  for (const State& state : states) {
    const auto beats_it = [&](const State& other) {
      return costs_no_more(other.spent, state.spent) && other.benefit_px >= state.benefit_px;
    };
    const auto first = kept.rbegin();
    if (std::none_of(first, first + std::min(kCompared, kept.rend() - first), beats_it))
      kept.push_back(state);
  }
  return kept;
}

Choice choice_of(std::vector<int> layers, std::span<const Candidate> candidates) {
  std::sort(layers.begin(), layers.end());
  Choice choice{std::move(layers), 0, true};
  for (const Candidate& candidate : candidates)
    if (std::binary_search(choice.layers.begin(), choice.layers.end(), candidate.layer))
      choice.benefit_px += candidate.benefit_px;
  return choice;
}

LayerCost limited_part(const LayerCost& cost, const Budget& budget) {
  return {budget.polygons == kNoLimit ? 0 : cost.polygons, budget.pixels == kNoLimit ? 0 : cost.pixels,
          budget.chunks == kNoLimit ? 0 : cost.chunks, 0};
}

LayerCost sum(const LayerCost& a, const LayerCost& b) {
  return {a.polygons + b.polygons, a.pixels + b.pixels, a.chunks + b.chunks, 0};
}

/// The most that the candidates from some place on could add if they were divisible, and if only the sum of
/// the shares of the budgets were limited (which is implied by the budgets themselves). The candidates are in
/// the order of benefit per share, so divisible ones are taken from the front.
class DivisibleRest {
 public:
  DivisibleRest(std::span<const Candidate> order, const Budget& budget) : budget_(budget) {
    limits_ = (budget.polygons != kNoLimit) + (budget.pixels != kNoLimit) + (budget.chunks != kNoLimit);
    shares_ = benefits_ = {0};
    for (const Candidate& candidate : order) {
      shares_.push_back(shares_.back() + share_of_budget(candidate.cost, budget));
      benefits_.push_back(benefits_.back() + candidate.benefit_px);
    }
  }

  /// An upper bound of the benefit of `state` after the candidates from `first` on.
  double most(const State& state, std::size_t first) const {
    const double left = std::max(0.0, limits_ - share_of_budget(state.spent, budget_));  // 0: rounding
    const double until = shares_[first] + left;
    std::size_t next =
        std::upper_bound(shares_.begin() + static_cast<std::ptrdiff_t>(first), shares_.end(), until) -
        shares_.begin();
    double bound = state.benefit_px + benefits_[next - 1] - benefits_[first];
    if (next < shares_.size())
      bound += (benefits_[next] - benefits_[next - 1]) * (until - shares_[next - 1]) /
               (shares_[next] - shares_[next - 1]);
    return bound;
  }

 private:
  Budget budget_;
  double limits_ = 0;
  std::vector<double> shares_, benefits_;  ///< of all candidates before each place
};

/// The dynamic program: all candidates one after the other, in the order of benefit per cost.
class Search {
 public:
  Search(std::span<const Candidate> order, const Budget& budget, double to_exceed)
      : order_(order), budget_(budget), rest_(order, budget), to_exceed_(to_exceed) {}

  /// False if more than `most_states` were needed.
  bool run(std::size_t most_states) {
    for (std::size_t c = 0; c < order_.size(); ++c) {
      extend(c);
      if (history_.size() > most_states) return false;
    }
    return true;
  }

  /// The layers of the best state; empty if none exceeds what it had to.
  std::vector<int> best() const {
    const State* best = nullptr;
    for (const State& state : states_)
      if (!best || state.benefit_px > best->benefit_px) best = &state;
    std::vector<int> chosen;
    for (const State* s = best; s && s->candidate >= 0; s = &history_[s->parent])
      chosen.push_back(order_[s->candidate].layer);
    return chosen;
  }

 private:
  void extend(std::size_t c) {
    const LayerCost cost = limited_part(order_[c].cost, budget_);
    std::vector<State> next;
    for (const State& state : states_) {
      if (promises(state, c + 1)) next.push_back(state);
      const LayerCost spent = sum(state.spent, cost);
      if (!budget_.affords(spent)) continue;
      const State taken{spent, state.benefit_px + order_[c].benefit_px, static_cast<int>(history_.size()),
                        static_cast<int>(c)};
      if (!promises(taken, c + 1)) continue;
      history_.push_back(state);  // only what is built upon is kept for the way back
      next.push_back(taken);
    }
    states_ = unbeaten(std::move(next));
  }

  bool promises(const State& state, std::size_t next) const { return rest_.most(state, next) > to_exceed_; }

  std::span<const Candidate> order_;
  Budget budget_;
  DivisibleRest rest_;
  double to_exceed_;
  std::vector<State> states_ = {State{}};
  std::vector<State> history_;
};

constexpr int kNone = -1;

/// `kept`, ascending, and then whatever fits, in the order given; but not the layer `given_up`.
std::vector<int> fill_up(const std::vector<int>& kept, int given_up, std::span<const Candidate> order,
                         const Budget& budget) {
  const auto is_kept = [&](int layer) { return std::binary_search(kept.begin(), kept.end(), layer); };
  Budget left = budget;
  for (const Candidate& candidate : order)
    if (is_kept(candidate.layer)) left = after(left, candidate.cost);
  std::vector<int> chosen = kept;
  for (const Candidate& candidate : order) {
    if (candidate.layer == given_up || is_kept(candidate.layer) || !left.affords(candidate.cost)) continue;
    left = after(left, candidate.cost);
    chosen.push_back(candidate.layer);
  }
  return chosen;
}

}  // namespace

Choice greedy_choice(std::span<const Candidate> candidates, const Budget& budget) {
  std::vector<Candidate> order(candidates.begin(), candidates.end());
  sort_by_benefit_per_cost(order, budget);
  std::vector<int> chosen;
  Budget left = budget;
  for (const Candidate& candidate : order) {
    if (!left.affords(candidate.cost)) continue;
    left = after(left, candidate.cost);
    chosen.push_back(candidate.layer);
  }
  return choice_of(std::move(chosen), candidates);
}

Choice best_choice(std::span<const Candidate> candidates, const Budget& budget) {
  std::vector<Candidate> by_ratio(candidates.begin(), candidates.end());
  sort_by_benefit_per_cost(by_ratio, budget);
  std::vector<Candidate> by_benefit = by_ratio;
  std::stable_sort(by_benefit.begin(), by_benefit.end(),
                   [](const Candidate& a, const Candidate& b) { return a.benefit_px > b.benefit_px; });
  Choice best = greedy_choice(candidates, budget);
  const auto try_with = [&](const std::vector<int>& kept, int given_up) {
    bool gained = false;
    for (const std::vector<Candidate>* order : {&by_ratio, &by_benefit}) {
      Choice filled = choice_of(fill_up(kept, given_up, *order, budget), candidates);
      if (!(filled.benefit_px > best.benefit_px * (1 + 1e-12))) continue;
      best = std::move(filled);
      gained = true;
    }
    return gained;
  };
  const auto fits = [&](const Candidate& c) { return budget.affords(c.cost); };
  const auto single = std::find_if(by_benefit.begin(), by_benefit.end(), fits);
  if (single != by_benefit.end()) try_with({single->layer}, kNone);
  for (bool gained = true; gained;) {
    gained = false;
    const std::vector<int> chosen = best.layers;
    for (std::size_t i = 0; i < chosen.size() && !gained; ++i) {
      std::vector<int> kept = chosen;
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
      gained = try_with(kept, chosen[i]);
    }
  }
  return best;
}

Choice choose(ChoiceRule rule, std::span<const Candidate> candidates, const Budget& budget) {
  return rule == ChoiceRule::Best ? best_choice(candidates, budget) : greedy_choice(candidates, budget);
}

Choice optimal_choice(std::span<const Candidate> candidates, const Budget& budget, std::size_t most_states) {
  TALISMAN_CHECK_GE(most_states, std::size_t{1});
  Choice greedy = greedy_choice(candidates, budget);
  std::vector<Candidate> order(candidates.begin(), candidates.end());
  sort_by_benefit_per_cost(order, budget);
  // Sums in another order differ by rounding: what is not better by more than that is no better.
  Search search(order, budget, greedy.benefit_px * (1 + 1e-12));
  if (!search.run(most_states)) {
    greedy.exact = false;
    return greedy;
  }
  Choice best = choice_of(search.best(), candidates);
  return best.benefit_px > greedy.benefit_px ? best : greedy;
}

double BudgetGap::gap() const {
  return optimal_px > 0 ? std::max(0.0, (optimal_px - greedy_px) / optimal_px) : 0;
}

BudgetGap budget_gap(std::span<const Candidate> candidates, const Budget& budget, std::size_t most_states,
                     ChoiceRule rule) {
  const Choice optimal = optimal_choice(candidates, budget, most_states);
  const double chosen = choose(rule, candidates, budget).benefit_px;
  return {chosen, std::max(chosen, optimal.benefit_px), optimal.exact};
}

double greedy_gap(std::span<const Candidate> candidates, const Budget& budget) {
  return budget_gap(candidates, budget).gap();
}

}  // namespace talisman::regulator
