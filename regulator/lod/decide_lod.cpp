// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/decide_lod.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "regulator/decision.h"
#include "regulator/lod/benefit.h"
#include "regulator/policies.h"
#include "regulator/profile.h"
#include "regulator/resolution.h"

namespace talisman::regulator {
namespace {

constexpr int kKeep = -1;  ///< the old sprite, or nothing

/// What may be done with one layer, beside what it costs and gives.
struct LayerWays {
  std::size_t at = 0;     ///< in the assessments
  std::vector<int> ways;  ///< by choice: kKeep, or an index into the ways to draw it
  double best_px = 0;     ///< the most that a picture would give
};

std::vector<LevelChoice> ways_of(const LayerAssessment& layer) {
  return layer.levels.empty() ? std::vector<LevelChoice>{{0, layer.resolution, layer.cost, 0}} : layer.levels;
}

double smear_of(double resolution) { return 1 / resolution - 1; }

/// What a level and a resolution lose, px, weighted.
double lost_px(const LayerAssessment& layer, double level_px, double resolution) {
  const layers::FiducialWeights& w = layer.preferences.importance;
  return (w.geometric > 0 ? w.geometric * level_px : 0) + w.sampling * smear_of(resolution);
}

double gain_by_error(const LayerAssessment& layer, const LevelChoice& way, double unmended_px) {
  const double lost = lost_px(layer, way.error_px, way.resolution);
  if (!layer.has_sprite) {
    const double side_px = std::sqrt(static_cast<double>(ways_of(layer)[0].cost.pixels));
    return std::max(0.0, layer.preferences.importance.geometric * side_px - lost);
  }
  const double then = lost_px(layer, layer.level_then_px, layer.resolution_then);
  return std::max(0.0, benefit_px(layer, unmended_px) + then - lost);
}

double gain_as_printed(const LayerAssessment& layer, const LevelChoice& way) {
  LodView view;
  view.size_px = static_cast<double>(ways_of(layer)[0].cost.pixels);
  view.triangles = view.vertices = static_cast<double>(std::max<std::int64_t>(way.cost.polygons, 1));
  view.importance = layer.preferences.importance.geometric;
  view.levels_switched = layer.has_sprite ? std::abs(way.level - layer.level_then) : 0;
  return printed_benefit(view, LodShading::Flat) * way.resolution;
}

double kept_as_printed(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.has_sprite) return 0;
  LevelChoice then;
  for (const LevelChoice& way : ways_of(layer))
    if (way.level == layer.level_then) {
      then = way;
      break;
    }
  const double most_px = std::max(options.thresholds.geometric_px, 1e-6);
  const double left = 1 - layer.fiducials.geometric.px / most_px;
  return left > 0 ? gain_as_printed(layer, then) * left : 0;
}

bool may_be_skipped(const LayerAssessment& layer, const RegulatorOptions& options) {
  return options.lod.first_appearance == FirstAppearance::Skip && layer.may_be_skipped;
}

/// The choices of one layer in view, cheapest kind first.
LayerWays choices_of(const LayerAssessment& layer, const RegulatorOptions& options, double unmended_px,
                     std::vector<LodChoice>& choices) {
  const bool as_printed = options.lod.benefit == LodBenefit::Printed;
  LayerWays result;
  const auto offer = [&](int way, double cost_ms, double benefit) {
    result.ways.push_back(way);
    choices.push_back({cost_ms, benefit});
  };
  const bool can_be_kept = layer.has_sprite && (layer.identical || has_sound_fit(layer));
  if (can_be_kept || may_be_skipped(layer, options))
    offer(kKeep, 0, as_printed ? kept_as_printed(layer, options) : 0);
  if (layer.has_sprite && has_sound_fit(layer) && barred_by_maximum_rate(layer)) return result;
  const std::vector<LevelChoice> ways = ways_of(layer);
  for (std::size_t k = 0; k < ways.size(); ++k) {
    if (!layer.has_sprite && options.lod.first_appearance == FirstAppearance::Draw && k > 0) break;
    const double gain =
        as_printed ? gain_as_printed(layer, ways[k]) : gain_by_error(layer, ways[k], unmended_px);
    const double error_gain = as_printed ? gain_by_error(layer, ways[k], unmended_px) : gain;
    result.best_px = std::max(result.best_px, error_gain);
    if (layer.has_sprite && !(error_gain > options.budget.cutoff_px)) continue;
    offer(static_cast<int>(k), drawing_ms(ways[k].cost, options), gain);
  }
  if (result.ways.empty()) offer(kKeep, 0, 0);
  return result;
}

std::string at_level(const LevelChoice& way, const std::vector<LevelChoice>& ways) {
  int levels = 1;
  for (const LevelChoice& other : ways) levels = std::max(levels, other.level + 1);
  std::string text;
  if (levels > 1) text = "; level " + std::to_string(way.level) + " of " + std::to_string(levels);
  return text + at_resolution(way.resolution);
}

std::string in_ms(const char* what, double ms) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.4g ms", what, ms);
  return text;
}

LayerDecision drawn(const LayerAssessment& layer, int way, double gain_px, const RegulatorOptions& options) {
  const std::vector<LevelChoice> ways = ways_of(layer);
  const LevelChoice& chosen = ways[static_cast<std::size_t>(way)];
  LayerDecision decision =
      rerender(layer, (layer.has_sprite ? comparison("benefit", gain_px, ">", options.budget.cutoff_px, "px")
                                        : std::string("first_appearance")) +
                          at_level(chosen, ways));
  decision.cost = chosen.cost;
  decision.level = chosen.level;
  decision.resolution = chosen.resolution;
  decision.shown_geometric_px = chosen.error_px;
  return decision;
}

LayerDecision kept(const LayerAssessment& layer, const LayerWays& ways, double left_ms,
                   const RegulatorOptions& options) {
  const std::vector<LevelChoice> all = ways_of(layer);
  const auto cheapest = [&] {
    double ms = HUGE_VAL;
    for (const LevelChoice& way : all) ms = std::min(ms, drawing_ms(way.cost, options));
    return ms;
  };
  if (!layer.has_sprite) {
    LayerDecision decision = drop(layer);
    decision.skipped = true;
    decision.reason = "skipped: budget, " + in_ms("needs", cheapest()) + in_ms(", left", left_ms);
    return decision;
  }
  LayerDecision decision;
  if (ways.ways.size() > 1) {
    decision =
        keep_old(layer, "deferred: budget, " + in_ms("needs", cheapest()) + in_ms(", left", left_ms) + "; " +
                            comparison("benefit", ways.best_px, ">", options.budget.cutoff_px, "px"));
    decision.deferred = true;
    decision.over_budget = cheapest() > options.budget.ms;
  } else if (nothing_to_gain(layer)) {
    decision = reuse(layer, "unchanged");
  } else if (benefit_px(layer) > options.budget.cutoff_px) {
    decision = keep_old(layer, "deferred: max_update_rate");
  } else {
    decision = keep_old(layer, comparison("benefit", ways.best_px, "<=", options.budget.cutoff_px, "px"));
  }
  decision.level = layer.level_then;
  decision.shown_geometric_px += layer.level_then_px;
  decision.reason += at_level({layer.level_then, layer.resolution_then, {}, 0}, all);
  return decision;
}

/// Which maps are drawn anew, and what is left for layers.
struct MapChoice {
  std::vector<bool> anew;
  double spent_ms = 0;
};

MapChoice choose_maps(std::span<const LayerAssessment> assessments, std::span<const MapAssessment> maps,
                      const RegulatorOptions& options) {
  MapChoice result;
  result.anew.resize(maps.size());
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const LayerAssessment& map = maps[k].map;
    if (!map.in_view || (map.has_sprite && map.identical)) continue;
    bool appears = false;
    for (const MapUse& use : maps[k].uses) {
      const auto layer = std::find_if(assessments.begin(), assessments.end(),
                                      [&](const LayerAssessment& a) { return a.layer == use.layer; });
      appears = appears || (layer != assessments.end() && layer->in_view && !layer->has_sprite);
    }
    const double ms = drawing_ms(map.cost, options);
    // Without a map nothing that looks it up can be drawn.
    if (!appears && map.has_sprite && result.spent_ms + ms > options.budget.ms / 2) continue;
    result.anew[k] = true;
    result.spent_ms += ms;
  }
  return result;
}

std::vector<LayerDecision> decisions_of_maps(std::span<const MapAssessment> maps, const MapChoice& chosen,
                                             std::span<const LayerDecision> layers) {
  std::vector<LayerDecision> decisions;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const LayerAssessment& map = maps[k].map;
    if (map.in_view && chosen.anew[k] && is_looked_up(maps[k], layers))
      decisions.push_back(rerender(map, map.has_sprite ? "out of date" : "first_appearance"));
    else
      decisions.push_back(keep_map(maps[k], map.identical ? "unchanged" : "deferred: budget"));
  }
  return decisions;
}

}  // namespace

double drawing_ms(const LayerCost& cost, const RegulatorOptions& options) {
  const double depth = std::max(1.0, options.budget.depth_complexity);
  const auto filled = static_cast<std::int64_t>(std::ceil(static_cast<double>(cost.pixels) * depth));
  return modelled_time(talisman_1996(), cost.polygons, filled, 0).render_ms;
}

FramePlan decide_lod(int frame, std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                     std::span<const MapAssessment> maps, LodSolver* solver) {
  const MapChoice chosen_maps = choose_maps(assessments, maps, options);
  LodProblem problem;
  std::vector<LayerWays> all;
  for (std::size_t i = 0; i < assessments.size(); ++i) {
    if (!assessments[i].in_view) continue;
    std::vector<LodChoice> choices;
    all.push_back(
        choices_of(assessments[i], options, moved_on(assessments[i].layer, maps, chosen_maps.anew), choices));
    all.back().at = i;
    problem.add(choices);
  }
  problem.budget_ms = std::max(0.0, options.budget.ms - chosen_maps.spent_ms);
  LodSolver fresh;
  const LodSolution solution = (solver ? solver : &fresh)->solve(problem);
  FramePlan plan{frame, {}, {}, {}};
  plan.lod = LodPlan{solution.benefit,
                     solution.upper_bound,
                     solution.cost_ms + chosen_maps.spent_ms,
                     solution.fits && chosen_maps.spent_ms <= options.budget.ms,
                     solution.iterations,
                     0};
  for (const LayerAssessment& layer : assessments) plan.decisions.push_back(drop(layer));
  for (std::size_t g = 0; g < all.size(); ++g) {
    const LayerAssessment& layer = assessments[all[g].at];
    const auto chosen = static_cast<std::size_t>(solution.chosen[g]);
    const int way = all[g].ways[chosen];
    LayerDecision& decision = plan.decisions[all[g].at];
    if (way == kKeep) {
      decision = kept(layer, all[g], problem.budget_ms - solution.cost_ms, options);
      plan.lod->skipped += decision.skipped;
      continue;
    }
    const double gain = problem.choices[static_cast<std::size_t>(problem.first[g]) + chosen].benefit;
    decision = drawn(layer, way, gain, options);
    if (!plan.lod->fits && !layer.has_sprite)
      decision.reason += in_ms("; overdraws budget: the coarsest of all need", plan.lod->cost_ms);
  }
  plan.maps = decisions_of_maps(maps, chosen_maps, plan.decisions);
  show_held_maps(maps, plan.maps, plan.decisions);
  return plan;
}

void say_levels(std::span<const LayerAssessment> assessments, std::vector<LayerDecision>& decisions) {
  for (std::size_t i = 0; i < assessments.size(); ++i) {
    const LayerAssessment& layer = assessments[i];
    LayerDecision& decision = decisions[i];
    if (layer.levels.size() < 2 || decision.action == Action::Drop) continue;
    const LevelChoice* now = nullptr;
    for (const LevelChoice& way : layer.levels)
      if (way.level == layer.level) now = &way;
    if (decision.action == Action::Rerender) {
      decision.level = layer.level;
      decision.shown_geometric_px += now->error_px;
      decision.reason += at_level(*now, layer.levels);
    } else {
      decision.level = layer.level_then;
      // What a render would mend of the level's error is in the fiducial already.
      decision.shown_geometric_px += std::min(layer.level_then_px, now->error_px);
      decision.reason += at_level({layer.level_then, 1, {}, 0}, layer.levels);
    }
  }
}

}  // namespace talisman::regulator
