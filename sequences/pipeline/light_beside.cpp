// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/light_beside.h"

#include <algorithm>
#include <map>

namespace talisman::sequences {

double light_beside_px(const PipelineState& state, const FrameReport& report, const layers::Layer& layer,
                       const layers::LayerState& now) {
  const LayerMemory& base = state.memory[layer.base];
  const LayerMemory& light = state.memory[layer.id];
  const regulator::LayerDecision& of_base = report.plan.decisions[layer.base];
  const regulator::LayerDecision& of_light = report.plan.decisions[layer.id];
  const double bound = of_base.shown_geometric_px + of_light.shown_geometric_px;
  if (!base.then || !light.then) return bound;
  const bool alike = base.depicts_frame == light.depicts_frame &&
                     of_base.shown_warp.now_from_then == of_light.shown_warp.now_from_then;
  if (alike) return 0;
  const layers::Polyhedron& hull = report.layers.bound(layer.base).hull;
  const auto from_base = layers::correspond(*base.then, now, hull);
  const auto from_light = layers::correspond(*light.then, now, hull);
  std::map<int, layers::dvec2> base_px;  // by characteristic point
  for (std::size_t i = 0; i < from_base.point.size(); ++i)
    if (from_base.point[i] >= 0) base_px[from_base.point[i]] = of_base.shown_warp(from_base.then_px[i]);
  double farthest = -1;
  for (std::size_t i = 0; i < from_light.point.size(); ++i) {
    const auto there = base_px.find(from_light.point[i]);
    if (there == base_px.end()) continue;
    farthest = std::max(farthest, glm::distance(there->second, of_light.shown_warp(from_light.then_px[i])));
  }
  return farthest >= 0 ? std::min(farthest, bound) : bound;
}

}  // namespace talisman::sequences
