// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect/inspect_order.h"

#include <algorithm>
#include <cstdio>
#include <span>

#include <nlohmann/json.hpp>

#include "sequences/content/value_type.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/visibility_fields.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// The layers of every frame add up to nothing that says something.
constexpr std::span kCounters = std::span(kVisibilityFields).subspan(1);

std::vector<std::string> names_of(const LayerTable& layers, const std::vector<int>& ids) {
  std::vector<std::string> names;
  names.reserve(ids.size());
  for (const int id : ids) names.push_back(layers[id].name);
  return names;
}

void add_order(OrderOverTime& result, int frame, std::vector<std::string> names) {
  if (!result.runs.empty() && result.runs.back().back_to_front == names)
    result.runs.back().last = frame;
  else
    result.runs.push_back({frame, frame, std::move(names)});
}

void add_merger(OrderOverTime& result, int frame, const LayerTable& layers, const Merger& merger) {
  const layers::Layer& layer = layers[merger.layer];
  const auto lasts = [&](const MergedRun& run) { return run.name == layer.name && run.last == frame - 1; };
  const auto run = std::find_if(result.merged.begin(), result.merged.end(), lasts);
  if (run != result.merged.end())
    run->last = frame;
  else
    result.merged.push_back({frame, frame, layer.name, names_of(layers, layer.members), merger.why});
}

/// The same layers may be related otherwise in the next frame: then the expression is another.
void add_resolved(OrderOverTime& result, int frame, const LayerTable& layers, const ResolvedCycle& cycle) {
  const std::vector<std::string> members = names_of(layers, cycle.layers);
  const std::string why = to_string(cycle.expression, layers.set().layers);
  const auto lasts = [&](const MergedRun& run) {
    return run.members == members && run.why == why && run.last == frame - 1;
  };
  const auto run = std::find_if(result.resolved.begin(), result.resolved.end(), lasts);
  if (run != result.resolved.end())
    run->last = frame;
  else
    result.resolved.push_back({frame, frame, "", members, why});
}

void add_counters(OrderOverTime& result, const FrameOrder& order) {
  ++result.frames;
  result.frames_sorted += order.sorted;
  result.frames_with_cycles += order.counters.merged_components > 0 || !order.resolved.empty();
  for (const VisibilityField& c : kCounters) result.sum.*c.field += order.counters.*c.field;
  result.merged_parts += order.merged_parts;
  if (!order.sorted) return;
  result.sort_ms += order.sort_ms;
  result.slowest_sort_ms = std::max(result.slowest_sort_ms, order.sort_ms);
}

}  // namespace

OrderOverTime order_over_time(const Sequence& sequence, const Settings& settings) {
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  OrderOverTime result;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    begin_frame(pipeline, state, frame);
    captured_states(pipeline, state, frame);  // the motion is not part of the sort's time
    const FrameOrder order = order_layers(pipeline, state, frame);
    add_order(result, frame, names_of(state.layers, order.back_to_front));
    for (const Merger& merger : order.mergers) add_merger(result, frame, state.layers, merger);
    for (const ResolvedCycle& cycle : order.resolved) add_resolved(result, frame, state.layers, cycle);
    add_counters(result, order);
  }
  return result;
}

std::string order_text(const Sequence& sequence, const OrderOverTime& order) {
  std::string text =
      formatted("%s: visibility order of %d frames, %zu layers; %zu different orders\n\n",
                sequence.name.c_str(), order.frames, sequence.layers.layers.size(), order.runs.size());
  text += "  frames       back to front\n";
  for (const OrderRun& run : order.runs)
    text += formatted("  %5d-%-5d  ", run.first, run.last) + joined(run.back_to_front) + "\n";
  text += "\n  merged       into one sprite, and why\n";
  for (const MergedRun& run : order.merged)
    text += formatted("  %5d-%-5d  ", run.first, run.last) + joined(run.members) + ": " + run.why + "\n";
  if (order.merged.empty()) text += "  never\n";
  if (!order.resolved.empty()) text += "\n  apart        in a cycle, by which expression\n";
  for (const MergedRun& run : order.resolved)
    text += formatted("  %5d-%-5d  ", run.first, run.last) + joined(run.members) + ": " + run.why + "\n";
  text +=
      formatted("\n  sorted in %d frames, with cycles in %d; %.3f ms a frame on average, %.3f ms at most\n  ",
                order.frames_sorted, order.frames_with_cycles,
                order.frames_sorted > 0 ? order.sort_ms / order.frames_sorted : 0, order.slowest_sort_ms);
  for (const VisibilityField& c : kCounters) text += formatted("%s %d, ", c.name, order.sum.*c.field);
  return text + "merged_parts " + std::to_string(order.merged_parts) + " over all frames\n";
}

std::string order_json(const Sequence& sequence, const OrderOverTime& order) {
  Json runs = Json::array(), merged = Json::array(), resolved = Json::array(), counters = Json::object();
  for (const OrderRun& run : order.runs)
    runs.push_back({{"first", run.first}, {"last", run.last}, {"back_to_front", run.back_to_front}});
  for (const MergedRun& run : order.merged)
    merged.push_back({{"first", run.first},
                      {"last", run.last},
                      {"name", run.name},
                      {"members", run.members},
                      {"why", run.why}});
  for (const MergedRun& run : order.resolved)
    resolved.push_back(
        {{"first", run.first}, {"last", run.last}, {"members", run.members}, {"expression", run.why}});
  for (const VisibilityField& c : kCounters) counters[c.name] = order.sum.*c.field;
  counters["merged_parts"] = order.merged_parts;
  const Json json = {{"schema", "talisman.order/1"},
                     {"sequence", sequence.name},
                     {"frames", order.frames},
                     {"frames_sorted", order.frames_sorted},
                     {"frames_with_cycles", order.frames_with_cycles},
                     {"orders", runs},
                     {"merged", merged},
                     {"resolved", resolved},
                     {"counters", counters},
                     {"sort_ms", order.sort_ms},
                     {"slowest_sort_ms", order.slowest_sort_ms}};
  return json.dump(2) + "\n";
}

}  // namespace talisman::sequences
