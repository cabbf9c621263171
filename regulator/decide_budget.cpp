// SPDX-License-Identifier: Apache-2.0
// Steps 5 and 7 of regulator/budget.h over layers and shadow maps, and what is said of it.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>

#include "regulator/budget.h"
#include "regulator/decision.h"
#include "regulator/policies.h"
#include "regulator/resolution.h"
#include "regulator/settle.h"

namespace talisman::regulator {

namespace {

bool first_appears(const LayerAssessment& layer) { return layer.in_view && !layer.has_sprite; }

/// One of the things of which there is a budget.
struct Limited {
  const char* what;
  std::int64_t needed, left, whole;
  bool by_time;  ///< the limit follows from budget_ms
};

std::array<Limited, 3> all_limited(const LayerCost& cost, const Budget& left,
                                   const RegulatorOptions& options) {
  const Budget whole = frame_budget(options);
  return {
      {{"polygons", cost.polygons, left.polygons, whole.polygons, whole.polygons < options.budget.polygons},
       {"pixels", cost.pixels, left.pixels, whole.pixels, whole.pixels < options.budget.pixels},
       {"chunks", cost.chunks, left.chunks, whole.chunks, false}}};
}

/// "polygons 5000 > 3000 left of 8000", for the first budget that is too small, or "dearer than the whole
/// budget of 4000 polygons, needs 5000"; empty if it fits.
std::string excess(const LayerCost& cost, const Budget& left, const RegulatorOptions& options) {
  if (left.affords(cost)) return {};
  const auto all = all_limited(cost, left, options);
  const auto time = [&](const Limited& l) {
    char text[48] = "";
    if (l.by_time) std::snprintf(text, sizeof text, " in %.4g ms", options.budget.ms);
    return std::string(text);
  };
  for (const Limited& l : all)
    if (l.needed > l.whole)
      return "dearer than the whole budget of " + std::to_string(l.whole) + " " + l.what + time(l) +
             ", needs " + std::to_string(l.needed);
  for (const Limited& l : all)
    if (l.needed > l.left)
      return std::string(l.what) + " " + std::to_string(l.needed) + " > " + std::to_string(l.left) +
             " left of " + std::to_string(l.whole) + time(l);
  return {};
}

/// Decisions that do not depend on the budget; candidates stay as "cut-off" until they are ranked.
LayerDecision decide_without_budget(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.in_view) return drop(layer);
  if (!layer.has_sprite) return rerender(layer, "first_appearance" + at_resolution(layer.resolution));
  if (nothing_to_gain(layer)) return reuse(layer, "unchanged" + at_resolution(layer.resolution_then));
  const double benefit = benefit_px(layer);
  const double cutoff = options.budget.cutoff_px;
  if (is_candidate(layer, options)) {
    LayerDecision old = keep_old(
        layer, benefit > cutoff ? comparison("deferred: old shadow map; benefit", benefit, ">", cutoff, "px")
                                : "deferred: old shadow map; " + settle_reason(layer));
    old.deferred = true;
    return old;
  }
  if (benefit > cutoff) return keep_old(layer, "deferred: max_update_rate");
  return keep_old(layer, comparison("benefit", benefit, "<=", cutoff, "px"));
}

using Maps = std::span<const MapAssessment>;

const LayerAssessment& layer_with(int id, std::span<const LayerAssessment> assessments) {
  return *std::find_if(assessments.begin(), assessments.end(),
                       [id](const LayerAssessment& a) { return a.layer == id; });
}

/// Maps that were never drawn and are looked up by a layer that appears.
std::vector<bool> maps_that_appear(std::span<const LayerAssessment> assessments, Maps maps) {
  std::vector<bool> appear(maps.size());
  for (std::size_t k = 0; k < maps.size(); ++k)
    appear[k] = !maps[k].map.has_sprite &&
                std::any_of(maps[k].uses.begin(), maps[k].uses.end(), [&](const MapUse& use) {
                  return first_appears(layer_with(use.layer, assessments));
                });
  return appear;
}

/// Maps of which a new picture would mend something, by index.
std::vector<std::size_t> maps_worth_drawing(std::span<const LayerAssessment> assessments, Maps maps,
                                            const std::vector<bool>& appear,
                                            const RegulatorOptions& options) {
  std::vector<std::size_t> worth;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (appear[k] || maps[k].map.identical) continue;
    const auto gains = [&](const MapUse& use) {
      const LayerAssessment& layer = layer_with(use.layer, assessments);
      const bool is_drawn = first_appears(layer) || is_candidate(layer, options);
      return is_drawn && (!maps[k].map.has_sprite || use.moved_px > options.budget.cutoff_px);
    };
    if (std::any_of(maps[k].uses.begin(), maps[k].uses.end(), gains)) worth.push_back(k);
  }
  return worth;
}

/// Is there a map, old or new, for each light whose shadow it shows?
bool can_be_drawn(int layer, Maps maps, const std::vector<bool>& drawn_anew) {
  for (std::size_t k = 0; k < maps.size(); ++k)
    if (!maps[k].map.has_sprite && !drawn_anew[k])
      for (const MapUse& use : maps[k].uses)
        if (use.layer == layer) return false;
  return true;
}

Alternative alternative_of(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                           Maps maps, std::vector<bool> drawn_anew, const Budget& left) {
  const std::vector<bool> none(maps.size());
  Alternative alternative{std::move(drawn_anew), {}, left, 0};
  for (const LayerAssessment& layer : assessments) {
    const double unmended = moved_on(layer.layer, maps, alternative.drawn_anew);
    if (first_appears(layer) && layer.preferences.importance.geometric > 0)
      alternative.sure_px +=
          layer.preferences.importance.geometric * (moved_on(layer.layer, maps, none) - unmended);
    if (is_candidate(layer, options, unmended) && can_be_drawn(layer.layer, maps, alternative.drawn_anew))
      alternative.candidates.push_back({layer.layer, benefit_px(layer, unmended), layer.cost});
  }
  return alternative;
}

/// The alternative that is taken, and what is chosen from it.
struct Taken {
  Alternative alternative;
  Choice choice;
  double total_px() const { return alternative.sure_px + choice.benefit_px; }
};

Taken take_best(std::span<const LayerAssessment> assessments, const RegulatorOptions& options, Maps maps) {
  std::optional<Taken> best;
  for (Alternative& alternative : alternatives_of(assessments, options, maps)) {
    Choice choice = choose(options.budget.choice, alternative.candidates, alternative.left);
    Taken taken{std::move(alternative), std::move(choice)};
    // Sums in another order differ by rounding: what is not better by more than that is no better.
    if (!best || taken.total_px() > best->total_px() * (1 + 1e-12)) best = std::move(taken);
  }
  return std::move(*best);
}

bool is_chosen(const Choice& choice, int layer) {
  return std::binary_search(choice.layers.begin(), choice.layers.end(), layer);
}

Budget after_chosen(const Taken& taken) {
  Budget left = taken.alternative.left;
  for (const Candidate& candidate : taken.alternative.candidates)
    if (is_chosen(taken.choice, candidate.layer)) left = after(left, candidate.cost);
  return left;
}

bool dearer_than_all(const LayerCost& cost, const RegulatorOptions& options) {
  return !frame_budget(options).affords(cost);
}

/// What was put off, because of what it lacks.
void defer(LayerDecision& decision, const LayerCost& cost, const Budget& left,
           const RegulatorOptions& options) {
  decision.deferred = true;
  decision.over_budget = dearer_than_all(cost, options);
  decision.short_of_area = cost.pixels > left.pixels || cost.chunks > left.chunks;
}

/// Walks through the candidates in the order of benefit per cost, spends, and says what each of them lacks.
void decide_candidates(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                       const Taken& taken, std::vector<LayerDecision>& decisions) {
  std::vector<Candidate> order = taken.alternative.candidates;
  sort_by_benefit_per_cost(order, taken.alternative.left);
  const Budget in_the_end = after_chosen(taken);
  Budget left = taken.alternative.left;
  for (const Candidate& candidate : order) {
    const LayerAssessment& layer = layer_with(candidate.layer, assessments);
    const bool settled = settles(layer, options);
    const std::string detail =
        (!layer.new_picture.empty() ? layer.new_picture
         : settled                  ? settle_reason(layer)
                   : comparison("benefit", candidate.benefit_px, ">", options.budget.cutoff_px, "px")) +
        at_resolution(layer.resolution);
    LayerDecision& decision = decisions[&layer - assessments.data()];
    if (is_chosen(taken.choice, candidate.layer)) {
      decision = rerender(layer, detail);
      decision.settled = settled;
      left = after(left, candidate.cost);
      continue;
    }
    const Budget& lacking = left.affords(candidate.cost) ? in_the_end : left;
    decision =
        keep_old(layer, "deferred: budget, " + excess(candidate.cost, lacking, options) + "; " + detail);
    defer(decision, candidate.cost, lacking, options);
  }
}

/// The decisions about shadow maps that follow from those about layers.
std::vector<LayerDecision> decide_maps_within(Maps maps, const RegulatorOptions& options, const Taken& taken,
                                              std::span<const LayerDecision> layers) {
  const Budget left = after_chosen(taken);
  std::vector<LayerDecision> decisions;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const LayerAssessment& map = maps[k].map;
    const std::string moved =
        comparison("shadow moved", map.fiducials.geometric.px, ">", options.budget.cutoff_px, "px") +
        at_resolution(map.resolution);
    if (map.in_view && taken.alternative.drawn_anew[k] && is_looked_up(maps[k], layers)) {
      decisions.push_back(
          rerender(map, map.has_sprite ? moved : "first_appearance" + at_resolution(map.resolution)));
      continue;
    }
    if (!map.in_view || map.identical || !(map.fiducials.geometric.px > options.budget.cutoff_px)) {
      decisions.push_back(keep_map(maps[k], map.identical ? "unchanged" : "its shadows have not moved"));
      continue;
    }
    const std::string lack = excess(map.cost, left, options);
    decisions.push_back(keep_map(
        maps[k], "deferred: budget, " + (lack.empty() ? "layers gain more by it" : lack) + "; " + moved));
    defer(decisions.back(), map.cost, left, options);
  }
  return decisions;
}

/// What appears is drawn even beyond the budget, and says so.
void say_overdrafts(std::span<const LayerAssessment> assessments, const RegulatorOptions& options, Maps maps,
                    BudgetDecisions& decided) {
  Budget left = frame_budget(options);
  const auto spend = [&](const LayerAssessment& item, LayerDecision& decision) {
    const std::string overdraft = excess(item.cost, left, options);
    if (!overdraft.empty()) decision.reason += "; overdraws budget: " + overdraft;
    left = after(left, item.cost);
  };
  for (std::size_t i = 0; i < assessments.size(); ++i)
    if (first_appears(assessments[i])) spend(assessments[i], decided.layers[i]);
  const std::vector<bool> appear = maps_that_appear(assessments, maps);
  for (std::size_t k = 0; k < maps.size(); ++k)
    if (appear[k]) spend(maps[k].map, decided.maps[k]);
}

}  // namespace

std::vector<Alternative> alternatives_of(std::span<const LayerAssessment> assessments,
                                         const RegulatorOptions& options, Maps maps) {
  const std::vector<bool> appear = maps_that_appear(assessments, maps);
  Budget left = left_after_first_appearances(assessments, options);
  for (std::size_t k = 0; k < maps.size(); ++k)
    if (appear[k]) left = after(left, maps[k].map.cost);
  const std::vector<std::size_t> worth = maps_worth_drawing(assessments, maps, appear, options);
  std::vector<unsigned> sets(std::size_t{1} << worth.size());
  std::iota(sets.begin(), sets.end(), 0u);
  std::stable_sort(sets.begin(), sets.end(),
                   [](unsigned a, unsigned b) { return std::popcount(a) < std::popcount(b); });
  std::vector<Alternative> alternatives;
  for (const unsigned set : sets) {
    std::vector<bool> drawn_anew = appear;
    Budget rest = left;
    bool affordable = true;
    for (std::size_t i = 0; i < worth.size(); ++i) {
      if (!(set >> i & 1u)) continue;
      const LayerCost& cost = maps[worth[i]].map.cost;
      affordable = affordable && rest.affords(cost);
      rest = after(rest, cost);
      drawn_anew[worth[i]] = true;
    }
    if (affordable)
      alternatives.push_back(alternative_of(assessments, options, maps, std::move(drawn_anew), rest));
  }
  return alternatives;
}

BudgetGap budget_gap_of_frame(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              Maps maps, std::size_t most_states) {
  BudgetGap of_frame;
  for (const Alternative& a : alternatives_of(assessments, options, maps)) {
    const BudgetGap gap = budget_gap(a.candidates, a.left, most_states, options.budget.choice);
    of_frame.greedy_px = std::max(of_frame.greedy_px, a.sure_px + gap.greedy_px);
    of_frame.optimal_px = std::max(of_frame.optimal_px, a.sure_px + gap.optimal_px);
    of_frame.exact = of_frame.exact && gap.exact;
  }
  return of_frame;
}

BudgetDecisions decide_budget(std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                              Maps maps) {
  BudgetDecisions decided;
  decided.layers.reserve(assessments.size());
  for (const LayerAssessment& layer : assessments)
    decided.layers.push_back(decide_without_budget(layer, options));
  const Taken taken = take_best(assessments, options, maps);
  decide_candidates(assessments, options, taken, decided.layers);
  decided.maps = decide_maps_within(maps, options, taken, decided.layers);
  say_overdrafts(assessments, options, maps, decided);
  show_held_maps(maps, decided.maps, decided.layers);
  return decided;
}

}  // namespace talisman::regulator
