// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/resolved_cycles.h"

#include <algorithm>

namespace talisman::sequences {

namespace {

using layers::CompositeExpression;
using layers::MergedComponent;

bool contains(const std::vector<int>& layers, int layer) {
  return std::find(layers.begin(), layers.end(), layer) != layers.end();
}

/// The first member that has shade layers; null: none has.
const layers::Layer* first_with_shade_layers(const LayerTable& authored, const std::vector<int>& members) {
  for (const layers::Layer& layer : authored)
    if (layer.base >= 0 && contains(members, layer.base)) return &authored[layer.base];
  return nullptr;
}

bool any_merged(const std::vector<int>& merged_before, const std::vector<int>& members) {
  return std::any_of(members.begin(), members.end(), [&](int layer) {
    return static_cast<std::size_t>(layer) < merged_before.size() && merged_before[layer] >= 0;
  });
}

}  // namespace

Resolution resolve_cycle(const Pipeline& pipeline, const std::vector<int>& merged_before,
                         const MergedComponent& component) {
  if (pipeline.settings.compositor == Compositor::Talisman) return {};
  if (component.reason == MergedComponent::Reason::Interpenetration) return {};
  if (component.reason == MergedComponent::Reason::Held && any_merged(merged_before, component.layers))
    return {};
  if (const layers::Layer* shaded = first_with_shade_layers(pipeline.authored, component.layers))
    return {std::nullopt, shaded->name + " has shade layers, so no expression is used"};
  CompositeExpression expression = layers::occlusion_expression(component);
  if (expression.status != CompositeExpression::Status::Resolved) return {};
  return {ResolvedCycle{component.layers, std::move(expression)}, {}};
}

std::string why_resolved(const LayerTable& layers, const ResolvedCycle& cycle, int layer) {
  constexpr int kShown = 6;
  std::string others;
  int count = 0;
  for (const int other : cycle.layers) {
    if (other == layer || ++count > kShown) continue;
    others += (others.empty() ? "" : ", ") + layers[other].name;
  }
  if (count > kShown) others += " and " + std::to_string(count - kShown) + " more";
  return "in a cycle with " + others + ": composited by an expression";
}

const ResolvedCycle* FrameOrder::resolved_with(int layer) const {
  for (const ResolvedCycle& cycle : resolved)
    if (contains(cycle.layers, layer)) return &cycle;
  return nullptr;
}

ResolvedCounters FrameOrder::resolved_counters() const {
  ResolvedCounters sum;
  for (const ResolvedCycle& cycle : resolved) {
    ++sum.components;
    sum.layers += static_cast<int>(cycle.layers.size());
    sum.registers = std::max(sum.registers, cycle.expression.registers);
    sum.reads += cycle.expression.reads;
    for (const layers::CompositeExpression::Node& node : cycle.expression.nodes)
      sum.operators += node.op != layers::CompositeExpression::Operator::Layer;
    ++sum.operators;  // over the frame
  }
  return sum;
}

}  // namespace talisman::sequences
