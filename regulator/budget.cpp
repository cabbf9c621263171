// SPDX-License-Identifier: Apache-2.0
#include "regulator/budget.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "regulator/policies.h"

namespace talisman::regulator {

namespace {

/// A budget that was spent beyond its end is empty, and no limit stays none.
std::int64_t less(std::int64_t budget, std::int64_t cost) {
  return budget == kNoLimit ? kNoLimit : std::max<std::int64_t>(budget - cost, 0);
}

Budget after(const Budget& budget, const LayerCost& cost) {
  return {less(budget.polygons, cost.polygons), less(budget.pixels, cost.pixels)};
}

double share(std::int64_t cost, std::int64_t budget) {
  if (budget == kNoLimit) return 0;
  return static_cast<double>(cost) / static_cast<double>(std::max<std::int64_t>(budget, 1));
}

bool appears(const LayerAssessment& layer) { return layer.in_view && !layer.has_sprite; }

double smear_px(const fiducials::Sampling& s) {
  return (std::fmax(s.magnification, 1) - 1) + (1 / std::fmin(s.minification, 1) - 1) +
         (std::fmax(s.anisotropy, 1) - 1);
}

/// "polygons 5000 > 3000 left of 8000", for the first budget that is too small; empty if it fits.
std::string excess(const LayerCost& cost, const Budget& left, const RegulatorOptions& options) {
  const auto text = [](const char* what, std::int64_t needed, std::int64_t rest, std::int64_t budget) {
    return std::string(what) + " " + std::to_string(needed) + " > " + std::to_string(rest) + " left of " +
           std::to_string(budget);
  };
  if (cost.polygons > left.polygons)
    return text("polygons", cost.polygons, left.polygons, options.budget_polygons);
  if (cost.pixels > left.pixels) return text("pixels", cost.pixels, left.pixels, options.budget_pixels);
  return {};
}

/// The old sprite where a render is not worth it or not affordable: warped if its warp is sound.
LayerDecision keep(const LayerAssessment& layer, std::string reason) {
  if (layer.identical || has_sound_fit(layer)) return reuse(layer, std::move(reason));
  return reuse_in_place(layer, reason + ", no warp");
}

/// Decisions that do not depend on the budget; candidates stay as "cut-off" until they are ranked.
LayerDecision decide_without_budget(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.in_view) return drop(layer);
  if (!layer.has_sprite) return rerender(layer, "first_appearance");
  if (layer.identical) return reuse(layer, "unchanged");
  const double benefit = benefit_px(layer);
  if (benefit > options.cutoff_px) return keep(layer, "deferred: max_update_rate");
  return keep(layer, comparison("benefit", benefit, "<=", options.cutoff_px, "px"));
}

/// First appearances spend first, whatever is left.
Budget draw_first_appearances(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              std::vector<LayerDecision>& decisions) {
  Budget left{options.budget_polygons, options.budget_pixels};
  for (std::size_t i = 0; i < assessments.size(); ++i) {
    if (!appears(assessments[i])) continue;
    const std::string overdraft = excess(assessments[i].cost, left, options);
    if (!overdraft.empty()) decisions[i].reason += "; overdraws budget: " + overdraft;
    left = after(left, assessments[i].cost);
  }
  return left;
}

/// A choice of some of the candidates that no other choice beats in all three numbers.
struct State {
  std::int64_t polygons = 0, pixels = 0;
  double benefit_px = 0;
  int parent = -1;  ///< index into the history; -1: nothing chosen
  int candidate = -1;
};

bool beats(const State& a, const State& b) {
  return a.polygons <= b.polygons && a.pixels <= b.pixels && a.benefit_px >= b.benefit_px;
}

/// Keeps of the states only those that no other beats. Sorted by polygons, a state can be beaten only by an
/// earlier one.
std::vector<State> unbeaten(std::vector<State> states) {
  std::stable_sort(states.begin(), states.end(), [](const State& a, const State& b) {
    if (a.polygons != b.polygons) return a.polygons < b.polygons;
    if (a.pixels != b.pixels) return a.pixels < b.pixels;
    return a.benefit_px > b.benefit_px;
  });
  std::vector<State> kept;
  for (const State& state : states) {
    const auto beats_it = [&](const State& other) { return beats(other, state); };
    if (std::none_of(kept.rbegin(), kept.rend(), beats_it)) kept.push_back(state);
  }
  return kept;
}

Choice choice_of(std::vector<int> layers, double benefit) {
  std::sort(layers.begin(), layers.end());
  return {std::move(layers), benefit, true};
}

}  // namespace

double benefit_px(const LayerAssessment& layer) {
  if (layer.identical) return 0;
  if (!has_sound_fit(layer) || due_by_minimum_rate(layer)) return kMostBenefitPx;
  const fiducials::Report& f = layer.fiducials;
  const layers::FiducialWeights& w = layer.preferences.importance;
  // A weight of zero silences its fiducial even where that is unbounded.
  const auto weighted = [](double weight, double px) { return weight > 0 ? weight * px : 0; };
  // What is not computed cannot matter.
  const double light_px = f.photometric.computed ? kPxPerLight * f.photometric.color : 0;
  const double hidden_px =
      (f.visibility.computed ? f.visibility.uncovered_px : 0) + (f.turned.computed ? f.turned.px : 0);
  const double benefit = weighted(w.geometric, f.geometric.px) + weighted(w.photometric, light_px) +
                         weighted(w.sampling, smear_px(f.sampling)) + weighted(w.visibility, hidden_px);
  return benefit < kMostBenefitPx ? benefit : kMostBenefitPx;  // NaN too
}

double share_of_budget(const LayerCost& cost, const Budget& budget) {
  return share(cost.polygons, budget.polygons) + share(cost.pixels, budget.pixels);
}

void sort_by_benefit_per_cost(std::vector<Candidate>& candidates, const Budget& budget) {
  const bool limited = budget.polygons != kNoLimit || budget.pixels != kNoLimit;
  const auto urgency = [&](const Candidate& c) {
    const double cost = limited ? share_of_budget(c.cost, budget) : 1;
    return cost > 0 ? c.benefit_px / cost : HUGE_VAL;
  };
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const double of_a = urgency(a), of_b = urgency(b);
    return of_a != of_b ? of_a > of_b : a.layer < b.layer;
  });
}

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
  Choice choice = choice_of(std::move(chosen), 0);
  for (const Candidate& candidate : candidates)
    if (std::binary_search(choice.layers.begin(), choice.layers.end(), candidate.layer))
      choice.benefit_px += candidate.benefit_px;
  return choice;
}

Choice optimal_choice(std::span<const Candidate> candidates, const Budget& budget, std::size_t most_states) {
  TALISMAN_CHECK_GE(most_states, std::size_t{1});
  std::vector<State> history;  // every state that was ever extended, for the way back
  std::vector<State> states = {State{}};
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Candidate& candidate = candidates[c];
    std::vector<State> next = states;
    for (const State& state : states) {
      const LayerCost spent{state.polygons + candidate.cost.polygons, state.pixels + candidate.cost.pixels, 0,
                            0};
      if (!budget.affords(spent)) continue;
      history.push_back(state);
      next.push_back({spent.polygons, spent.pixels, state.benefit_px + candidate.benefit_px,
                      static_cast<int>(history.size()) - 1, static_cast<int>(c)});
    }
    if (history.size() > most_states) {
      Choice greedy = greedy_choice(candidates, budget);
      greedy.exact = false;
      return greedy;
    }
    states = unbeaten(std::move(next));
  }
  const State* best = &states.front();
  for (const State& state : states)
    if (state.benefit_px > best->benefit_px) best = &state;
  std::vector<int> chosen;
  for (const State* s = best; s->candidate >= 0; s = &history[s->parent])
    chosen.push_back(candidates[s->candidate].layer);
  return choice_of(std::move(chosen), best->benefit_px);
}

double greedy_gap(std::span<const Candidate> candidates, const Budget& budget) {
  const double optimal = optimal_choice(candidates, budget).benefit_px;
  const double greedy = greedy_choice(candidates, budget).benefit_px;
  return optimal > 0 ? std::max(0.0, (optimal - greedy) / optimal) : 0;
}

std::vector<Candidate> candidates_of(std::span<const LayerAssessment> assessments,
                                     const RegulatorOptions& options) {
  std::vector<Candidate> candidates;
  for (const LayerAssessment& layer : assessments) {
    if (!layer.in_view || !layer.has_sprite) continue;
    const double benefit = benefit_px(layer);
    if (!(benefit > options.cutoff_px)) continue;
    if (has_sound_fit(layer) && barred_by_maximum_rate(layer)) continue;
    candidates.push_back({layer.layer, benefit, layer.cost});
  }
  return candidates;
}

Budget left_after_first_appearances(std::span<const LayerAssessment> assessments,
                                    const RegulatorOptions& options) {
  Budget left{options.budget_polygons, options.budget_pixels};
  for (const LayerAssessment& layer : assessments)
    if (appears(layer)) left = after(left, layer.cost);
  return left;
}

std::vector<LayerDecision> decide_budget(std::span<const LayerAssessment> assessments,
                                         const RegulatorOptions& options) {
  std::vector<LayerDecision> decisions;
  for (const LayerAssessment& layer : assessments) decisions.push_back(decide_without_budget(layer, options));
  Budget left = draw_first_appearances(assessments, options, decisions);

  const auto index_of = [&](int layer) {
    return std::find_if(assessments.begin(), assessments.end(),
                        [layer](const LayerAssessment& a) { return a.layer == layer; }) -
           assessments.begin();
  };
  std::vector<Candidate> order = candidates_of(assessments, options);
  sort_by_benefit_per_cost(order, left);
  for (const Candidate& candidate : order) {
    const LayerAssessment& layer = assessments[index_of(candidate.layer)];
    const std::string gain = comparison("benefit", candidate.benefit_px, ">", options.cutoff_px, "px");
    const std::string lack = excess(candidate.cost, left, options);
    LayerDecision& decision = decisions[index_of(candidate.layer)];
    decision = lack.empty() ? rerender(layer, gain) : keep(layer, "deferred: budget, " + lack + "; " + gain);
    if (lack.empty()) left = after(left, candidate.cost);
  }
  return decisions;
}

}  // namespace talisman::regulator
