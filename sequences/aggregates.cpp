// SPDX-License-Identifier: Apache-2.0
#include "sequences/aggregates.h"

#include <algorithm>
#include <chrono>
#include <map>

#include <glm/geometric.hpp>

#include "layers/aggregate.h"
#include "layers/check.h"
#include "layers/shading.h"
#include "sequences/layer_planning.h"
#include "sequences/resolved_cycles.h"

namespace talisman::sequences {

struct GrownPipeline {
  GrownPipeline(const Pipeline& authored, layers::LayerSet grown, std::vector<layers::LayerBound> bounds)
      : layers(std::move(grown)), pipeline(authored, layers, std::move(bounds)) {}
  layers::LayerSet layers;
  Pipeline pipeline;
};

namespace {

using layers::Layer;
using layers::LayerState;
using layers::MergedComponent;

int authored_count(const Pipeline& authored) { return static_cast<int>(authored.layers.layers.size()); }

// --- Making aggregates ---

/// The id of the aggregate of these layers, which is made if they never were merged before.
int aggregate_id(const Pipeline& authored, PipelineState& state, const std::vector<int>& members) {
  const Pipeline& before = with_aggregates(authored, state);
  for (std::size_t id = authored.layers.layers.size(); id < before.layers.layers.size(); ++id)
    if (before.layers.layers[id].members == members) return static_cast<int>(id);
  layers::LayerSet grown = before.layers;
  std::vector<layers::LayerBound> bounds = before.bounds;
  const int id = static_cast<int>(grown.layers.size());
  Layer aggregate = layers::aggregate_of(grown.layers, members, id);
  const std::string name = aggregate.name;
  const auto is_used = [&](const Layer& layer) { return layer.name == aggregate.name; };
  for (int k = 2; std::any_of(grown.layers.begin(), grown.layers.end(), is_used); ++k)
    aggregate.name = name + "#" + std::to_string(k);
  grown.layers.push_back(std::move(aggregate));
  bounds.push_back(layers::aggregate_bound(bounds, members));
  state.order.grown = std::make_shared<const GrownPipeline>(authored, std::move(grown), std::move(bounds));
  state.order.last_seen.push_back(-1);
  state.memory.emplace_back();
  return id;
}

std::string names_of(const Pipeline& pipeline, const std::vector<int>& members, const char* between) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < members.size() && i < kShown; ++i)
    text += (i > 0 ? between : "") + pipeline.layers.layers[members[i]].name;
  if (members.size() > kShown) text += " and " + std::to_string(members.size() - kShown) + " more";
  return text;
}

std::string why_merged(const Pipeline& pipeline, const MergedComponent& component) {
  switch (component.reason) {
    case MergedComponent::Reason::Interpenetration:
      return names_of(pipeline, component.cycle, " and ") + " occlude each other";
    case MergedComponent::Reason::Cycle:
      return "they occlude each other in a cycle (" + names_of(pipeline, component.cycle, " behind ") +
             " behind " + pipeline.layers.layers[component.cycle.front()].name + ")";
    case MergedComponent::Reason::Held:
      return "their cycle ended " + std::to_string(component.absent_frames) + " frames ago";
  }
  return {};
}

// --- Ordering ---

std::vector<layers::Occluder> occluders_in_view(const Pipeline& authored,
                                                const std::vector<LayerState>& states) {
  std::vector<layers::Occluder> occluders;
  for (const Layer& layer : authored.layers.layers) {
    const LayerState& state = states[layer.id];
    if (!state.touches_display || layer.base >= 0) continue;  // shade layers follow their bases
    occluders.push_back(
        {layer.id, layer.group, layers::convex_bodies(authored.bounds[layer.id], state.world_points)});
  }
  return occluders;
}

/// What the groups alone say, farthest group first; inside a group by id.
std::vector<int> by_group(std::span<const layers::Occluder> occluders) {
  std::vector<std::pair<layers::OrderGroup, int>> ranked;
  for (const layers::Occluder& occluder : occluders) ranked.emplace_back(occluder.group, occluder.layer);
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> order;
  for (const auto& [group, layer] : ranked) order.push_back(layer);
  return order;
}

double farthest_point(const layers::dvec3& eye, const LayerState& state) {
  double farthest = 0;
  for (const layers::dvec3& p : state.world_points) farthest = std::max(farthest, glm::distance(eye, p));
  return farthest;
}

/// An order of a cyclic component for authors who do not want it merged. Relations that hold in one direction
/// only are kept where they can be; where they go round, and where they say nothing, the layer whose farthest
/// point is farthest comes first: a land or a room reaches beyond what stands in it.
std::vector<int> order_of_cycle(const MergedComponent& component, const layers::dvec3& eye,
                                const std::vector<LayerState>& states) {
  const auto occludes = [&](int front, int behind) {
    const auto& relations = component.relations;
    return std::find(relations.begin(), relations.end(), layers::ExplicitPair{behind, front}) !=
           relations.end();
  };
  std::map<int, double> distance;
  for (const int layer : component.layers) distance[layer] = farthest_point(eye, states[layer]);
  std::vector<int> left = component.layers, order;
  while (!left.empty()) {
    const auto is_last = [&](int layer) {  // nothing that is left is certainly behind it
      return std::none_of(left.begin(), left.end(),
                          [&](int other) { return occludes(layer, other) && !occludes(other, layer); });
    };
    const bool some_last = std::any_of(left.begin(), left.end(), is_last);
    const auto before = [&](int a, int b) {
      const bool free_a = !some_last || is_last(a), free_b = !some_last || is_last(b);
      return free_a != free_b ? free_a : distance[a] > distance[b];
    };
    const auto next = std::min_element(left.begin(), left.end(), before);
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

void take_from_merged(const MergedComponent& component, layers::VisibilityCounters& counters) {
  --counters.merged_components;
  counters.merged_layers -= static_cast<int>(component.layers.size());
}

/// Turns the sorter's answer into layers with sprites: a component becomes its aggregate, or stays apart with
/// an expression or in some order.
void place_groups(const Pipeline& authored, PipelineState& state, const std::vector<LayerState>& states,
                  const layers::dvec3& eye, const layers::VisibilityOrder& visibility, FrameOrder& order) {
  auto merged = visibility.merged.begin();
  for (const std::vector<int>& group : visibility.groups_back_to_front) {
    if (group.size() == 1) {
      order.back_to_front.push_back(group.front());
      continue;
    }
    TALISMAN_CHECK(merged != visibility.merged.end() && merged->layers == group);
    const MergedComponent& component = *merged++;
    Resolution resolution = resolve_cycle(authored, state.order.merged_into, component);
    if (resolution.cycle || authored.settings.cycles == Cycles::Keep) {
      const std::vector<int> kept = order_of_cycle(component, eye, states);
      order.back_to_front.insert(order.back_to_front.end(), kept.begin(), kept.end());
      if (!resolution.cycle) continue;
      take_from_merged(component, order.counters);
      order.resolved.push_back(std::move(*resolution.cycle));
      continue;
    }
    const int id = aggregate_id(authored, state, group);
    order.back_to_front.push_back(id);
    const std::string why_not = resolution.why_not.empty() ? "" : "; " + resolution.why_not;
    order.mergers.push_back({id, why_merged(authored, component) + why_not});
    for (const int member : group) {
      order.merged_into[member] = id;
      order.merged_parts += static_cast<int>(authored.layers.layers[member].parts.size());
    }
  }
}

/// Shade layers lie directly in front of their bases; an aggregate holds the terms of its members itself.
void add_shade_layers(const Pipeline& authored, const PipelineState& state, FrameOrder& order) {
  const std::vector<Layer>& all = with_aggregates(authored, state).layers.layers;
  order.back_to_front = layers::with_shade_layers(all, order.back_to_front);
  for (const Layer& layer : authored.layers.layers)
    if (layer.base >= 0) order.merged_into[layer.id] = order.merged_into[layer.base];
}

// --- From frame to frame ---

/// Notes which aggregates exist now and gives up those that are gone for long.
void remember_order(const Pipeline& authored, PipelineState& state, int frame, const FrameOrder& order) {
  OrderMemory& memory = state.order;
  if (memory.merged_into != order.merged_into) ++memory.generation;
  memory.merged_into = order.merged_into;
  memory.frame = frame;
  for (const Merger& merger : order.mergers)
    memory.last_seen[merger.layer - authored_count(authored)] = frame;
  for (std::size_t k = 0; k < memory.last_seen.size(); ++k) {
    if (memory.last_seen[k] + kKeepAggregate_frames != frame) continue;
    const int id = authored_count(authored) + static_cast<int>(k);
    state.memory[id] = {};
    state.sprites.drop(id);
  }
}

void note_splits(const std::vector<int>& before, FrameOrder& order) {
  order.split_from.assign(order.merged_into.size(), -1);
  for (std::size_t layer = 0; layer < before.size(); ++layer)
    if (before[layer] >= 0 && order.merged_into[layer] != before[layer])
      order.split_from[layer] = before[layer];
}

}  // namespace

bool FrameOrder::has_own_sprite(int layer, bool is_aggregate) const {
  return is_aggregate ? merger(layer) != nullptr : merged_into[layer] < 0;
}

const Merger* FrameOrder::merger(int layer) const {
  for (const Merger& m : mergers)
    if (m.layer == layer) return &m;
  return nullptr;
}

const Pipeline& with_aggregates(const Pipeline& authored, const GrownPipeline* grown) {
  return grown ? grown->pipeline : authored;
}

const Pipeline& with_aggregates(const Pipeline& authored, const PipelineState& state) {
  return with_aggregates(authored, state.order.grown.get());
}

bool exists_now(const Pipeline& pipeline, const PipelineState& state, int layer) {
  const Layer& l = pipeline.layers.layers[layer];
  if (!l.is_aggregate()) return true;
  const std::vector<int>& merged_into = state.order.merged_into;
  return merged_into[l.members.front()] == layer;
}

FrameOrder order_layers(const Pipeline& authored, PipelineState& state, int frame) {
  const auto start = std::chrono::steady_clock::now();
  FrameOrder order;
  order.merged_into.assign(authored.layers.layers.size(), -1);
  const std::vector<LayerState>& states = states_at(authored, state, frame);
  const std::vector<layers::Occluder> occluders = occluders_in_view(authored, states);
  const bool one_pass = authored.settings.regulator.policy == regulator::Policy::Direct;
  if (!authored.sorts_visibility || one_pass) {
    order.back_to_front = by_group(occluders);
  } else {
    const layers::dvec3 eye(states.front().camera.world_from_camera[3]);
    const layers::VisibilityOrder visibility =
        state.order.sorter.sort(eye, occluders, authored.settings.explicit_order);
    order.sorted = true;
    order.counters = visibility.counters;
    place_groups(authored, state, states, eye, visibility, order);
  }
  add_shade_layers(authored, state, order);
  note_splits(state.order.merged_into, order);
  remember_order(authored, state, frame, order);
  order.sort_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return order;
}

void explain_order(const Pipeline& pipeline, FrameReport& report) {
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    const Layer& layer = pipeline.layers.layers[decision.layer];
    if (layer.is_aggregate()) {
      if (const Merger* merger = report.order.merger(layer.id))
        decision.reason += "; merged: " + merger->why;
      else
        decision.reason = "its layers can be ordered";
      continue;
    }
    const int into = report.order.merged_into[layer.id], from = report.order.split_from[layer.id];
    if (into >= 0)
      decision.reason =
          "merged into " + pipeline.layers.layers[into].name + ": " + report.order.merger(into)->why;
    else if (from >= 0 && decision.action != regulator::Action::Drop)
      decision.reason = "split from " + pipeline.layers.layers[from].name + ": " + decision.reason;
    if (const ResolvedCycle* cycle = report.order.resolved_with(layer.id))
      decision.reason += "; " + why_resolved(pipeline, *cycle, layer.id);
  }
}

}  // namespace talisman::sequences
