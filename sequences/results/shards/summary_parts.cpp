// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/shards/summary_parts.h"

#include <algorithm>
#include <stdexcept>

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Every member of a row that is not a sum or a list: one list for writing and for reading.
template <typename Row, typename Visit>
void for_each_plain(Row& row, const Visit& visit) {
  visit("name", row.name);
  visit("parts", row.parts);
  visit("polygons", row.polygons);
  visit("renders", row.renders);
  visit("frames_shown", row.frames_shown);
  visit("max_geometric_px", row.max_geometric_px);
  visit("sprite_width_px", row.sprite_px.x);
  visit("sprite_height_px", row.sprite_px.y);
  visit("merged_renders", row.merged_renders);
  visit("is_capped", row.is_capped);
  visit("is_aggregate", row.is_aggregate);
  visit("is_shadow_map", row.is_shadow_map);
  visit("is_mirror", row.is_mirror);
  visit("frames_deferred", row.frames_deferred);
  visit("frames_over_budget", row.frames_over_budget);
}

template <typename Row, typename Visit>
void for_each_sum(Row& row, const Visit& visit) {
  visit("sum_geometric_px", row.sum_geometric_px);
  visit("sum_resolution", row.sum_resolution);
  visit("render_ms", row.render_ms);
}

template <typename Summary, typename Visit>
void for_each_rows(Summary& summary, const Visit& visit) {
  visit("layers", summary.layers);
  visit("shadow_maps", summary.shadow_maps);
  visit("mirrors", summary.mirrors);
}

Json row_json(const LayerSummary& row) {
  Json json = Json::object();
  for_each_plain(row, [&](const char* name, const auto& value) { json[name] = value; });
  for_each_sum(row, [&](const char* name, const ExactSum& sum) { json[name] = sum.parts(); });
  Json reasons = Json::array();
  for (const ReasonKind& kind : row.reasons.kinds())
    reasons.push_back(
        {{"words", kind.words}, {"unit", kind.unit}, {"values", kind.values}, {"times", kind.times}});
  json["reasons"] = reasons;
  return json;
}

LayerSummary row_from(const Json& json) {
  LayerSummary row;
  for_each_plain(row, [&](const char* name, auto& value) { json.at(name).get_to(value); });
  for_each_sum(row, [&](const char* name, ExactSum& sum) {
    sum = ExactSum(json.at(name).get<std::vector<double>>());
  });
  std::vector<ReasonKind> kinds;
  for (const Json& kind : json.at("reasons"))
    kinds.push_back(
        {kind.at("words"), kind.at("unit"), kind.at("values").get<std::vector<double>>(), kind.at("times")});
  row.reasons = ReasonTally::of(std::move(kinds));
  return row;
}

layers::Effect effect_from(const std::string& name) {
  for (const layers::Effect effect : layers::kAllEffects)
    if (layers::name(effect) == name) return effect;
  throw std::invalid_argument("no effect");
}

void add_row(LayerSummary& row, const LayerSummary& later) {
  const auto area = [](const LayerSummary& r) { return std::int64_t{r.sprite_px.x} * r.sprite_px.y; };
  row.renders += later.renders;
  row.frames_shown += later.frames_shown;
  row.max_geometric_px = std::max(row.max_geometric_px, later.max_geometric_px);
  if (area(later) > area(row)) row.sprite_px = later.sprite_px;
  row.merged_renders += later.merged_renders;
  row.is_capped |= later.is_capped;
  row.frames_deferred += later.frames_deferred;
  row.frames_over_budget += later.frames_over_budget;
  row.sum_geometric_px += later.sum_geometric_px;
  row.sum_resolution += later.sum_resolution;
  row.render_ms += later.render_ms;
  row.reasons.add(later.reasons);
}

/// The author's layers and the aggregates lie in one order, of which an earlier part knows the beginning; maps and mirrors
/// are found by name.
void add_rows(std::vector<LayerSummary>& rows, const std::vector<LayerSummary>& later, bool in_order) {
  for (std::size_t i = 0; i < later.size(); ++i) {
    const auto same = [&](const LayerSummary& row) { return row.name == later[i].name; };
    const auto found = in_order ? rows.begin() + static_cast<std::ptrdiff_t>(std::min(i, rows.size()))
                                : std::find_if(rows.begin(), rows.end(), same);
    if (found == rows.end())
      rows.push_back(later[i]);
    else
      add_row(*found, later[i]);
  }
}

}  // namespace

Json parts_json(const Summary& s) {
  Json json = {{"sequence", s.sequence},
               {"policy", s.policy},
               {"warp", s.warp},
               {"compositor", s.compositor},
               {"display_px", {s.display_px.x, s.display_px.y}},
               {"compression_quality", s.compression_quality ? Json(*s.compression_quality) : Json(nullptr)},
               {"planned_only", s.planned_only},
               {"frames_deferred", s.frames_deferred}};
  Json effects = Json::array();
  for (std::size_t e = 0; e < s.effects.size(); ++e)
    effects.push_back({{"effect", layers::name(s.effects[e].effect)},
                       {"called", s.effects[e].called},
                       {"why", s.effects[e].why},
                       {"passes", s.effect_passes[e]}});
  json["effects"] = effects;
  for_each_rows(s, [&](const char* name, const std::vector<LayerSummary>& rows) {
    json[name] = Json::array();
    for (const LayerSummary& row : rows) json[name].push_back(row_json(row));
  });
  return json;
}

Summary summary_from(const Json& json) {
  Summary s;
  json.at("sequence").get_to(s.sequence);
  json.at("policy").get_to(s.policy);
  json.at("warp").get_to(s.warp);
  json.at("compositor").get_to(s.compositor);
  s.display_px = {json.at("display_px").at(0).get<int>(), json.at("display_px").at(1).get<int>()};
  if (!json.at("compression_quality").is_null())
    s.compression_quality = json.at("compression_quality").get<int>();
  json.at("planned_only").get_to(s.planned_only);
  json.at("frames_deferred").get_to(s.frames_deferred);
  for (const Json& effect : json.at("effects")) {
    layers::EffectCall call;
    call.effect = effect_from(effect.at("effect"));
    effect.at("called").get_to(call.called);
    effect.at("why").get_to(call.why);
    s.effects.push_back(call);
    s.effect_passes.push_back(effect.at("passes"));
  }
  for_each_rows(s, [&](const char* name, std::vector<LayerSummary>& rows) {
    for (const Json& row : json.at(name)) rows.push_back(row_from(row));
  });
  return s;
}

void add_part(Summary& summary, const Summary& later) {
  summary.frames_deferred += later.frames_deferred;
  for (std::size_t e = 0; e < summary.effect_passes.size() && e < later.effect_passes.size(); ++e)
    summary.effect_passes[e] += later.effect_passes[e];
  add_rows(summary.layers, later.layers, true);
  add_rows(summary.shadow_maps, later.shadow_maps, false);
  add_rows(summary.mirrors, later.mirrors, false);
}

}  // namespace talisman::sequences
