// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/aggregates.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

#include "layers/aggregate.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/seam.h"
#include "layers/shading.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/light_planning.h"
#include "sequences/pipeline/regrouping/shared_entries.h"
#include "sequences/pipeline/resolved_cycles.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::MergedComponent;

int authored_count(const Pipeline& pipeline) { return static_cast<int>(pipeline.authored.size()); }

// --- Making aggregates ---

using Members = std::vector<int>;

/// Takes a name that no layer of the run has.
std::string take_name(AggregateHistory& history, const std::string& wished) {
  constexpr int kFirstSuffix = 2;
  const auto [used, is_new] = history.names.try_emplace(wished, kFirstSuffix);
  if (is_new) return wished;
  std::string name;
  do name = wished + "#" + std::to_string(used->second++);
  while (!history.names.try_emplace(name, kFirstSuffix).second);
  return name;
}

/// The serial number of the aggregate, which is entered if these layers never were merged before.
int serial_of(const Pipeline& pipeline, AggregateHistory& history, const Members& members) {
  if (history.names.empty())
    for (const Layer& layer : pipeline.authored) take_name(history, layer.name);
  const int next = static_cast<int>(history.records.size());
  const auto [it, is_new] = history.serial_of.try_emplace(members, next);
  if (!is_new) return it->second;
  const Layer made = layers::aggregate_of(pipeline.authored.set().layers, members, -1);
  history.records.push_back(
      {take_name(history, made.name), static_cast<int>(made.parts.size()), made.polygons});
  return next;
}

/// What was captured under an id says nothing of the aggregate that has it now.
void forget_captured(PipelineState& state, int id) {
  for (auto& [frame, captured] : state.captured) {
    if (static_cast<std::size_t>(id) >= captured.states.size()) continue;
    captured.states[id].layer = -1;
    captured.placements[id].reset();
  }
}

/// A copy of a table to which aggregates are added.
class GrowingTable {
 public:
  explicit GrowingTable(const LayerTable& before) : set_(before.set()), bounds_(before.bounds()) {}

  /// `id` is that of an aggregate in the table, or the next one.
  void put_aggregate(const Pipeline& pipeline, const Members& members, int id, const std::string& name) {
    Layer aggregate = layers::aggregate_of(pipeline.authored.set().layers, members, id);
    aggregate.name = name;
    std::vector<const layers::LayerBound*> of_members;
    for (const int member : members) of_members.push_back(&pipeline.authored.bound(member));
    bounds_.put(id, following_light_and_faces(pipeline, aggregate, layers::aggregate_bound(of_members)));
    set_.layers.resize(std::max(set_.layers.size(), static_cast<std::size_t>(id) + 1));
    set_.layers[id] = std::move(aggregate);
  }

  LayerTable finished() { return {std::move(set_), std::move(bounds_)}; }

 private:
  layers::LayerSet set_;
  BoundTable bounds_;
};

/// The layers of a state while the aggregates of one frame are made; copied once, and only if one is new.
class Growth {
 public:
  Growth(const Pipeline& pipeline, PipelineState& state) : pipeline_(pipeline), state_(state) {}

  /// The id of the aggregate of these layers, which is made if it has none.
  int id_of(const Members& members) {
    const int serial = serial_of(pipeline_, state_.order.history, members);
    const int slot = slot_of(serial);
    state_.order.slots[slot].is_free = false;
    const int id = authored_count(pipeline_) + slot;
    if (state_.order.slots[slot].serial != serial) make(id, slot, serial, members);
    return id;
  }

  void finish() {
    if (table_) state_.layers = table_->finished();
  }

 private:
  /// The slot that it still has, else the first free one, else a new one.
  int slot_of(int serial) const {
    std::vector<AggregateSlot>& slots = state_.order.slots;
    const auto find = [&slots](auto is_wanted) {
      return std::find_if(slots.begin(), slots.end(), is_wanted);
    };
    auto slot = find([serial](const AggregateSlot& s) { return s.serial == serial; });
    if (slot == slots.end()) slot = find([](const AggregateSlot& s) { return s.is_free; });
    if (slot == slots.end()) slot = slots.insert(slots.end(), AggregateSlot{});
    return static_cast<int>(slot - slots.begin());
  }

  void make(int id, int slot, int serial, const Members& members) {
    if (!table_) table_.emplace(state_.layers);
    table_->put_aggregate(pipeline_, members, id, state_.order.history.records[serial].name);
    state_.order.slots[slot].serial = serial;
    state_.memory.resize(std::max(state_.memory.size(), static_cast<std::size_t>(id) + 1));
    forget_captured(state_, id);
  }

  const Pipeline& pipeline_;
  PipelineState& state_;
  std::optional<GrowingTable> table_;  ///< empty: nothing is new
};

std::string names_of(const LayerTable& layers, const std::vector<int>& members, const char* between) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < members.size() && i < kShown; ++i)
    text += (i > 0 ? between : "") + layers[members[i]].name;
  if (members.size() > kShown) text += " and " + std::to_string(members.size() - kShown) + " more";
  return text;
}

std::string why_merged(const LayerTable& layers, const MergedComponent& component) {
  switch (component.reason) {
    case MergedComponent::Reason::Interpenetration:
      return names_of(layers, component.cycle, " and ") + " occlude each other";
    case MergedComponent::Reason::Cycle:
      return "they occlude each other in a cycle (" + names_of(layers, component.cycle, " behind ") +
             " behind " + layers[component.cycle.front()].name + ")";
    case MergedComponent::Reason::Held:
      return "their cycle ended " + std::to_string(component.absent_frames) + " frames ago";
  }
  return {};
}

// --- Ordering ---

/// `with_bodies`: for the sort; the groups alone need none.
std::vector<layers::Occluder> occluders_in_view(const Pipeline& pipeline,
                                                const std::vector<LayerState>& states, bool with_bodies) {
  std::vector<layers::Occluder> occluders;
  for (const Layer& layer : pipeline.authored) {
    const LayerState& state = states[layer.id];
    if (!state.touches_display || layer.base >= 0) continue;  // shade layers follow their bases
    occluders.push_back({layer.id, layer.group, {}});
    if (!with_bodies) continue;
    occluders.back().bodies = layers::convex_bodies(pipeline.authored.bound(layer.id), state.world_points);
    std::vector<std::span<const layers::dvec3>>& bodies = occluders.back().bodies;
    if (!bodies.empty() && layers::has_seams(pipeline.scene, layer)) bodies.pop_back();
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
  const auto& members = component.layers;
  const std::size_t count = members.size();
  const auto index = [&](int layer) {
    return static_cast<std::size_t>(std::lower_bound(members.begin(), members.end(), layer) -
                                    members.begin());
  };
  std::vector<char> occludes(count * count, 0);  // front · count + behind
  for (const layers::ExplicitPair& p : component.relations)
    occludes[index(p.front) * count + index(p.behind)] = 1;
  const auto certainly_before = [&](std::size_t front, std::size_t behind) {
    return occludes[front * count + behind] && !occludes[behind * count + front];
  };
  std::vector<double> distance;
  for (const int layer : members) distance.push_back(farthest_point(eye, states[layer]));
  std::vector<std::size_t> left(count);
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<int> behind_it(count, 0), order;  // of those left, how many are certainly behind each
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) behind_it[a] += certainly_before(a, b);
  while (!left.empty()) {
    const auto is_last = [&](std::size_t a) { return behind_it[a] == 0; };
    const bool some_last = std::any_of(left.begin(), left.end(), is_last);
    const auto before = [&](std::size_t a, std::size_t b) {
      const bool free_a = !some_last || is_last(a), free_b = !some_last || is_last(b);
      return free_a != free_b ? free_a : distance[a] > distance[b];
    };
    const auto next = std::min_element(left.begin(), left.end(), before);
    order.push_back(members[*next]);
    for (const std::size_t a : left) behind_it[a] -= certainly_before(a, *next);
    left.erase(next);
  }
  return order;
}

void take_from_merged(const MergedComponent& component, layers::VisibilityCounters& counters) {
  --counters.merged_components;
  counters.merged_layers -= static_cast<int>(component.layers.size());
}

/// Puts the aggregate of these layers next in the order.
void place_merged(const Pipeline& pipeline, Growth& growth, const Members& members, std::string why,
                  FrameOrder& order) {
  const int id = growth.id_of(members);
  order.back_to_front.push_back(id);
  order.mergers.push_back({id, std::move(why)});
  for (const int member : members) {
    order.merged_into[member] = id;
    order.merged_parts += static_cast<int>(pipeline.authored[member].parts.size());
  }
}

/// Turns the sorter's answer into layers with sprites: a component becomes its aggregate, or stays apart with
/// an expression or in some order; what is cheaper together becomes an aggregate as well.
void place_groups(const Pipeline& pipeline, PipelineState& state, const std::vector<LayerState>& states,
                  const layers::dvec3& eye, const layers::VisibilityOrder& visibility, FrameOrder& order) {
  Growth growth(pipeline, state);
  for (const OrderEntry& entry : order_entries(pipeline, visibility, state)) {
    if (entry.why_shared != nullptr) {
      place_merged(pipeline, growth, entry.layers, *entry.why_shared, order);
      continue;
    }
    if (entry.cycle == nullptr) {
      order.back_to_front.push_back(entry.layers.front());
      continue;
    }
    const MergedComponent& component = *entry.cycle;
    Resolution resolution = resolve_cycle(pipeline, state.order.merged_into, component);
    if (resolution.cycle || pipeline.settings.cycles == Cycles::Keep) {
      const std::vector<int> kept = order_of_cycle(component, eye, states);
      order.back_to_front.insert(order.back_to_front.end(), kept.begin(), kept.end());
      if (!resolution.cycle) continue;
      take_from_merged(component, order.counters);
      order.resolved.push_back(std::move(*resolution.cycle));
      continue;
    }
    const std::string why_not = resolution.why_not.empty() ? "" : "; " + resolution.why_not;
    place_merged(pipeline, growth, entry.layers, why_merged(pipeline.authored, component) + why_not, order);
  }
  growth.finish();
}

/// Shade layers lie directly in front of their bases; an aggregate holds the terms of its members itself.
void add_shade_layers(const Pipeline& pipeline, const PipelineState& state, FrameOrder& order) {
  order.back_to_front = layers::with_shade_layers(state.layers.set().layers, order.back_to_front);
  for (const Layer& layer : pipeline.authored)
    if (layer.base >= 0) order.merged_into[layer.id] = order.merged_into[layer.base];
}

// --- From frame to frame ---

/// Notes which aggregates exist now and gives up those that are gone for long.
void remember_order(const Pipeline& pipeline, PipelineState& state, int frame, const FrameOrder& order) {
  OrderMemory& memory = state.order;
  if (memory.merged_into != order.merged_into) ++memory.generation;
  memory.merged_into = order.merged_into;
  memory.frame = frame;
  for (const Merger& merger : order.mergers)
    memory.slots[merger.layer - authored_count(pipeline)].last_seen = frame;
  for (std::size_t k = 0; k < memory.slots.size(); ++k) {
    if (memory.slots[k].is_free || memory.slots[k].last_seen + kKeepAggregate_frames > frame) continue;
    const int id = authored_count(pipeline) + static_cast<int>(k);
    memory.slots[k].is_free = true;
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

void adopt_layers(const Pipeline& pipeline, PipelineState& state) {
  if (state.authored.is_copy_of(pipeline.authored)) return;
  TALISMAN_CHECK_EQ(state.authored.size(), pipeline.authored.size());  // a state of other layers
  const LayerTable before = state.layers;
  state.layers = state.authored = pipeline.authored;
  if (before.size() == state.authored.size()) return;
  GrowingTable table(pipeline.authored);
  for (std::size_t id = state.authored.size(); id < before.size(); ++id)
    table.put_aggregate(pipeline, before[id].members, before[id].id, before[id].name);
  state.layers = table.finished();
}

bool exists_now(const PipelineState& state, int layer) {
  const Layer& l = state.layers[layer];
  if (!l.is_aggregate()) return true;
  const std::vector<int>& merged_into = state.order.merged_into;
  return merged_into[l.members.front()] == layer;
}

FrameOrder order_layers(const Pipeline& pipeline, PipelineState& state, int frame) {
  const Stopwatch watch;
  FrameOrder order;
  order.merged_into.assign(pipeline.authored.size(), -1);
  const std::vector<LayerState>& states = captured_states(pipeline, state, frame);
  const bool sorts = layers::is_built(layers::Effect::VisibilitySort) && pipeline.sorts_visibility &&
                     draws_sprites(pipeline);
  const std::vector<layers::Occluder> occluders = occluders_in_view(pipeline, states, sorts);
  if (!sorts) {
    order.back_to_front = by_group(occluders);
  } else {
    const layers::dvec3 eye(states.front().camera.world_from_camera[3]);
    const layers::VisibilityOrder visibility =
        state.order.sorter.sort(eye, occluders, pipeline.settings.explicit_order);
    order.sorted = true;
    order.counters = visibility.counters;
    place_groups(pipeline, state, states, eye, visibility, order);
  }
  add_shade_layers(pipeline, state, order);
  note_splits(state.order.merged_into, order);
  order.why_split = std::move(state.regroup.why_split);
  state.regroup.why_split.clear();
  remember_order(pipeline, state, frame, order);
  order.sort_ms = watch.ms();
  return order;
}

FrameOrder standing_order(const FrameOrder& of_beat) {
  FrameOrder order = of_beat;
  order.sorted = false;
  order.counters = {};
  order.merged_parts = 0;
  order.split_from.assign(order.merged_into.size(), -1);
  order.sort_ms = 0;
  return order;
}

int row_in_run(const PipelineState& state, int layer) {
  const int authored = static_cast<int>(state.order.merged_into.size());
  return layer < authored ? layer : authored + state.order.slots[layer - authored].serial;
}

std::vector<int> layers_with_lines(const PipelineState& state, const FrameReport& report) {
  std::vector<int> layers(report.order.merged_into.size());
  std::iota(layers.begin(), layers.end(), 0);
  const auto first_aggregate = static_cast<std::ptrdiff_t>(layers.size());
  for (const Merger& merger : report.order.mergers) layers.push_back(merger.layer);
  std::sort(layers.begin() + first_aggregate, layers.end(),
            [&](int a, int b) { return row_in_run(state, a) < row_in_run(state, b); });
  return layers;
}

namespace {

/// " (cheaper apart: …)", or empty.
std::string why_split(const FrameOrder& order, int layer) {
  const auto why = order.why_split.find(layer);
  return why != order.why_split.end() ? " (" + why->second + ")" : "";
}

}  // namespace

void explain_order(FrameReport& report) {
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    const Layer& layer = report.layers[decision.layer];
    if (layer.is_aggregate()) {
      if (const Merger* merger = report.order.merger(layer.id))
        decision.reason += "; merged: " + merger->why;
      else
        decision.reason = "its layers can be ordered";
      continue;
    }
    const int into = report.order.merged_into[layer.id], from = report.order.split_from[layer.id];
    if (into >= 0)
      decision.reason = "merged into " + report.layers[into].name + ": " + report.order.merger(into)->why;
    else if (from >= 0 && decision.action != regulator::Action::Drop)
      decision.reason = "split from " + report.layers[from].name + why_split(report.order, layer.id) + ": " +
                        decision.reason;
    if (const ResolvedCycle* cycle = report.order.resolved_with(layer.id))
      decision.reason += "; " + why_resolved(report.layers, *cycle, layer.id);
  }
}

}  // namespace talisman::sequences
