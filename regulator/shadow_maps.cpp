// SPDX-License-Identifier: Apache-2.0
#include "regulator/shadow_maps.h"

#include <algorithm>
#include <utility>

#include "regulator/decision.h"

namespace talisman::regulator {

namespace {

const LayerDecision* decision_of(int layer, std::span<const LayerDecision> decisions) {
  const auto it = std::find_if(decisions.begin(), decisions.end(),
                               [layer](const LayerDecision& d) { return d.layer == layer; });
  return it == decisions.end() ? nullptr : &*it;
}

/// Is the map as good as a new one, or good enough?
std::string why_kept(const MapAssessment& map, std::span<const LayerDecision> decisions,
                     const RegulatorOptions& options) {
  if (map.map.has_sprite && map.map.identical) return "unchanged";
  if (!is_looked_up(map, decisions)) return "no layer that looks it up is drawn";
  const double limit = options.thresholds.shadow_map_px, moved = map.map.fiducials.geometric.px;
  if (map.map.has_sprite && options.policy == Policy::Threshold && limit > 0 && moved <= limit)
    return comparison("shadow moved", moved, "<=", limit, "px");
  return {};
}

}  // namespace

double moved_on(int layer, std::span<const MapAssessment> maps, const std::vector<bool>& drawn_anew) {
  double moved = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (drawn_anew[k] || maps[k].map.identical || !maps[k].map.has_sprite) continue;
    for (const MapUse& use : maps[k].uses)
      if (use.layer == layer) moved = std::max(moved, use.moved_px);
  }
  return moved;
}

bool is_looked_up(const MapAssessment& map, std::span<const LayerDecision> decisions) {
  return std::any_of(map.uses.begin(), map.uses.end(), [&](const MapUse& use) {
    const LayerDecision* decision = decision_of(use.layer, decisions);
    return decision && decision->action == Action::Rerender;
  });
}

LayerDecision keep_map(const MapAssessment& map, std::string reason) {
  if (!map.map.in_view) {
    LayerDecision out_of_view = drop(map.map);
    out_of_view.reason = "no layer in view looks it up";
    return out_of_view;
  }
  LayerDecision decision = reuse_in_place(map.map, std::move(reason));
  decision.shown_geometric_px = map.map.fiducials.geometric.px;
  return decision;
}

std::vector<LayerDecision> decide_maps(std::span<const MapAssessment> maps,
                                       std::span<const LayerDecision> decisions,
                                       const RegulatorOptions& options) {
  std::vector<LayerDecision> decided;
  for (const MapAssessment& map : maps) {
    std::string kept = why_kept(map, decisions, options);
    if (!kept.empty() || !map.map.in_view)
      decided.push_back(keep_map(map, std::move(kept)));
    else if (!map.map.has_sprite)
      decided.push_back(rerender(map.map, "first_appearance"));
    else if (options.policy == Policy::Threshold && options.thresholds.shadow_map_px > 0)
      decided.push_back(rerender(map.map, comparison("shadow moved", map.map.fiducials.geometric.px, ">",
                                                     options.thresholds.shadow_map_px, "px")));
    else
      decided.push_back(rerender(map.map, "light or casters changed"));
  }
  return decided;
}

void show_held_maps(std::span<const MapAssessment> maps, std::span<const LayerDecision> of_maps,
                    std::vector<LayerDecision>& decisions) {
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (of_maps[k].action == Action::Rerender || maps[k].map.identical) continue;
    for (const MapUse& use : maps[k].uses)
      for (LayerDecision& decision : decisions) {
        if (decision.layer != use.layer || decision.action != Action::Rerender) continue;
        decision.shown_geometric_px = std::max(decision.shown_geometric_px, use.moved_px);
        decision.reason += "; old " + maps[k].name;
      }
  }
}

}  // namespace talisman::regulator
