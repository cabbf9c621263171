// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run_difference.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/results/finished_run.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;
/// By frame and layer.
using Decisions = std::map<std::pair<int, std::string>, Json>;

std::string text_at(const Json& json, const std::string& key) {
  if (!json.contains(key)) return "-";
  return json[key].is_string() ? json[key].get<std::string>() : json[key].dump();
}

/// Members that differ, in the order of `a`, and behind them those that only `b` has.
void add_differences(const Json& a, const Json& b, std::vector<SettingDifference>& differences) {
  std::vector<std::string> names;
  for (const auto& item : a.items()) names.push_back(item.key());
  for (const auto& item : b.items())
    if (!a.contains(item.key())) names.push_back(item.key());
  for (const std::string& name : names)
    if (text_at(a, name) != text_at(b, name))
      differences.push_back({name, text_at(a, name), text_at(b, name)});
}

std::vector<SettingDifference> setting_differences(const Json& a, const Json& b) {
  std::vector<SettingDifference> differences;
  for (const char* key : {"sequence", "kind", "frames"})
    if (text_at(a, key) != text_at(b, key)) differences.push_back({key, text_at(a, key), text_at(b, key)});
  add_differences(a.at("settings"), b.at("settings"), differences);
  for (const char* key : {"options", "content"}) {
    const Json none = Json::object();
    add_differences(a.contains(key) ? a[key] : none, b.contains(key) ? b[key] : none, differences);
  }
  return differences;
}

std::optional<double> number_at(const Json& json, const char* key) {
  if (!json.contains(key) || !json[key].is_number()) return std::nullopt;
  return json[key].get<double>();
}

std::vector<CostDifference> cost_differences(const Json& a, const Json& b) {
  std::vector<CostDifference> costs;
  for (const char* key : {"mean_update_rate", "cost_weighted_update_rate", "polygons_rendered",
                          "pixels_rendered", "modelled_drawing_ms", "modelled_ms"})
    if (number_at(a, key) || number_at(b, key)) costs.push_back({key, number_at(a, key), number_at(b, key)});
  return costs;
}

std::vector<LayerRates> layer_rates(const Json& a, const Json& b) {
  std::vector<LayerRates> layers;
  const auto row_of_layer = [&layers](const std::string& name) -> LayerRates& {
    for (LayerRates& layer : layers)
      if (layer.layer == name) return layer;
    layers.push_back({name, {}, {}, {}, {}, 0});
    return layers.back();
  };
  for (const Json& layer : a.at("layers")) {
    LayerRates& row = row_of_layer(layer.at("name").get<std::string>());
    row.renders_a = number_at(layer, "renders"), row.rate_a = number_at(layer, "update_rate");
  }
  for (const Json& layer : b.at("layers")) {
    LayerRates& row = row_of_layer(layer.at("name").get<std::string>());
    row.renders_b = number_at(layer, "renders"), row.rate_b = number_at(layer, "update_rate");
  }
  return layers;
}

Decisions by_frame_and_layer(std::vector<Json> lines) {
  Decisions decisions;
  for (Json& line : lines) {
    std::pair<int, std::string> place{line.at("frame").get<int>(), line.at("layer").get<std::string>()};
    decisions[std::move(place)] = std::move(line);
  }
  return decisions;
}

std::set<int> frames_of_decisions(const Decisions& decisions) {
  std::set<int> frames;
  for (const auto& [place, line] : decisions) frames.insert(place.first);
  return frames;
}

std::string in_words(const Json* line) {
  return line ? text_at(*line, "decision") + ": " + text_at(*line, "reason") : "-";
}

std::string done_in(const Json* line) { return line ? text_at(*line, "decision") : "-"; }

void compare_decisions(const Decisions& a, const Decisions& b, RunDifference& difference) {
  const std::set<int> in_a = frames_of_decisions(a), in_b = frames_of_decisions(b);
  std::set<int> both;
  std::set_intersection(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(), std::inserter(both, both.end()));
  std::set_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                      std::back_inserter(difference.only_a));
  std::set_difference(in_b.begin(), in_b.end(), in_a.begin(), in_a.end(),
                      std::back_inserter(difference.only_b));
  difference.frames = static_cast<int>(both.size());
  std::set<std::pair<int, std::string>> places;
  for (const Decisions* decisions : {&a, &b})
    for (const auto& [place, line] : *decisions)
      if (both.count(place.first) > 0) places.insert(place);
  difference.decisions = static_cast<int>(places.size());
  for (const auto& place : places) {
    const auto at_a = a.find(place), at_b = b.find(place);
    const Json *line_a = at_a == a.end() ? nullptr : &at_a->second,
               *line_b = at_b == b.end() ? nullptr : &at_b->second;
    if (done_in(line_a) == done_in(line_b)) continue;
    difference.decided.push_back({place.first, place.second, in_words(line_a), in_words(line_b)});
    for (LayerRates& layer : difference.layers) layer.decided_otherwise += layer.layer == place.second;
  }
}

std::string number_or_dash(const std::optional<double>& value, const char* pattern) {
  return value ? number_text(pattern, *value) : "-";
}

PageTable costs_table(const RunDifference& difference) {
  PageTable table{{"cost", "A", "B", "B of A %"}, {}, 1};
  for (const CostDifference& cost : difference.costs)
    table.rows.push_back({cost.name, number_or_dash(cost.a, "%.6g"), number_or_dash(cost.b, "%.6g"),
                          cost.a && cost.b ? percent_of(*cost.b, *cost.a) : "-"});
  return table;
}

PageTable layers_table(const RunDifference& difference) {
  PageTable table{{"layer", "renders A", "renders B", "rate A %", "rate B %", "decided otherwise"}, {}, 1};
  const auto percent = [](const std::optional<double>& rate) { return rate ? fixed(100 * *rate, 1) : "-"; };
  for (const LayerRates& layer : difference.layers)
    table.rows.push_back({layer.layer, number_or_dash(layer.renders_a, "%.0f"),
                          number_or_dash(layer.renders_b, "%.0f"), percent(layer.rate_a),
                          percent(layer.rate_b), std::to_string(layer.decided_otherwise)});
  return table;
}

std::string settings_text(const RunDifference& difference) {
  if (difference.settings.empty()) return "settings and content are the same\n";
  PageTable table{{"setting", "A", "B"}, {}, 3};
  for (const SettingDifference& setting : difference.settings)
    table.rows.push_back({setting.name, setting.a, setting.b});
  return plain_text(table);
}

Json json_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

}  // namespace

RunDifference run_difference(const std::string& folder_a, const std::string& folder_b) {
  const Json run_a = finished_run(folder_a), run_b = finished_run(folder_b);
  require_all_decisions(run_a, folder_a, "a difference of runs");
  require_all_decisions(run_b, folder_b, "a difference of runs");
  const Json summary_a = finished_summary(folder_a), summary_b = finished_summary(folder_b);
  const Decisions a = by_frame_and_layer(finished_decisions(folder_a)),
                  b = by_frame_and_layer(finished_decisions(folder_b));
  RunDifference difference;
  try {
    difference.settings = setting_differences(run_a, run_b);
    difference.costs = cost_differences(summary_a, summary_b);
    difference.layers = layer_rates(summary_a, summary_b);
    compare_decisions(a, b, difference);
  } catch (const Json::exception&) {
    throw InputError(
        "run.json, summary.json or decisions.jsonl is not as a run writes it, there or in " + folder_b,
        folder_a);
  }
  if (difference.frames == 0) throw InputError("no frame in common with " + folder_b, folder_a);
  return difference;
}

std::string text_of(const RunDifference& difference, std::size_t most_decisions) {
  std::string text = settings_text(difference) + "\n" + plain_text(costs_table(difference)) + "\n" +
                     plain_text(layers_table(difference)) + "\n" + std::to_string(difference.decided.size()) +
                     " of " + std::to_string(difference.decisions) + " decisions of " +
                     std::to_string(difference.frames) + " frames differ\n";
  if (difference.decided.empty()) return text;
  PageTable table{{"frame", "layer", "A", "B"}, {}, 4};
  const std::size_t shown = std::min(most_decisions, difference.decided.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const DecisionDifference& decision = difference.decided[k];
    table.rows.push_back({std::to_string(decision.frame), decision.layer, decision.a, decision.b});
  }
  text += plain_text(table);
  if (shown < difference.decided.size())
    text += "... and " + std::to_string(difference.decided.size() - shown) + " more; --json has them all\n";
  return text;
}

Json json_of(const RunDifference& difference) {
  Json settings = Json::array(), costs = Json::array(), layers = Json::array(), decided = Json::array();
  for (const SettingDifference& setting : difference.settings)
    settings.push_back({{"name", setting.name}, {"a", setting.a}, {"b", setting.b}});
  for (const CostDifference& cost : difference.costs)
    costs.push_back({{"name", cost.name}, {"a", json_or_null(cost.a)}, {"b", json_or_null(cost.b)}});
  for (const LayerRates& layer : difference.layers)
    layers.push_back({{"layer", layer.layer},
                      {"renders_a", json_or_null(layer.renders_a)},
                      {"renders_b", json_or_null(layer.renders_b)},
                      {"update_rate_a", json_or_null(layer.rate_a)},
                      {"update_rate_b", json_or_null(layer.rate_b)},
                      {"decided_otherwise", layer.decided_otherwise}});
  for (const DecisionDifference& decision : difference.decided)
    decided.push_back(
        {{"frame", decision.frame}, {"layer", decision.layer}, {"a", decision.a}, {"b", decision.b}});
  return {{"settings", settings},
          {"costs", costs},
          {"layers", layers},
          {"frames", difference.frames},
          {"only_a", difference.only_a},
          {"only_b", difference.only_b},
          {"decisions", difference.decisions},
          {"decided_otherwise", decided}};
}

}  // namespace talisman::sequences
