// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/live_plan.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/stopwatch.h"
#include "sequences/results/column_json.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/report/changes.h"
#include "sequences/results/report/flat_line.h"
#include "sequences/view/flights.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// What the map and its sums are made from, and the curves; all else is asked for by the frame.
constexpr std::array<std::string_view, 7> kMapColumns = {
    "frame", "layer", "decision", "reason", "geometric_px", "cost_polygons", "cost_pixels"};
constexpr std::array<std::string_view, 9> kCurveColumns = {
    "frame",           "polygons_rendered", "polygons_reference",
    "pixels_rendered", "pixels_reference",  "mean_geometric_px",
    "sprite_bytes",    "modelled_ms",       "modelled_drawing_ms"};

/// The table's columns of these names, as lists by name that grow row by row.
template <typename Row>
class ColumnLists {
 public:
  template <typename Names>
  ColumnLists(const ColumnTable<Row>& table, const Names& names) {
    for (const Column<Row>& column : table.columns)
      if (std::find(names.begin(), names.end(), column.name) != names.end()) columns_.push_back(&column);
    lists_.resize(columns_.size(), Json::array());
  }
  void add(const Row& row) {
    for (std::size_t k = 0; k < columns_.size(); ++k) lists_[k].push_back(json_of(columns_[k]->get(row)));
  }
  Json take() {
    Json json = Json::object();
    for (std::size_t k = 0; k < columns_.size(); ++k) json[columns_[k]->name] = std::move(lists_[k]);
    return json;
  }

 private:
  std::vector<const Column<Row>*> columns_;
  std::vector<Json> lists_;
};

Json json_of_cell(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  if (const auto* word = std::get_if<std::string>(&cell)) return *word;
  return nullptr;
}

}  // namespace

std::vector<ColumnInfo> live_columns() {
  std::vector<ColumnInfo> columns = flat_columns(decision_table());
  const std::vector<ColumnInfo> changes = flat_columns(change_table());
  columns.insert(columns.end(), changes.begin() + kChangeKeys, changes.end());
  return columns;
}

LivePlan::LivePlan(LiveScene live)
    : live_(std::move(live)),
      pipeline_(make_pipeline(*live_.variant.sequence.scene, live_.variant.sequence.layers,
                              live_.variant.settings)),
      state_(std::make_unique<PipelineState>(pipeline_)) {}

bool LivePlan::follow(const std::vector<CameraPose>& flight) {
  if (!live_.flown || flight.empty()) return false;
  fly(*live_.flown, flight, live_.variant.sequence.fps);
  live_.variant.sequence.frames = pipeline_.settings.frames = static_cast<int>(flight.size());
  state_ = std::make_unique<PipelineState>(pipeline_);
  planned_.clear();
  return true;
}

void LivePlan::advance(double ms, const std::function<bool()>& is_stale) {
  const Stopwatch watch;
  for (int frame = planned(); frame < frames(); ++frame) {
    PlannedFrame made;
    made.report = step(pipeline_, *state_, frame, nullptr);
    for (const DecisionRow& row : decision_rows(*state_, made.report)) {
      PlannedRow place;
      for (std::size_t m = 0; m < made.report.shadow_maps.size(); ++m)
        if (&made.report.shadow_maps[m].decision == &row.decision) place.map = static_cast<int>(m);
      if (place.map < 0) place.layer = row.decision.layer;
      if (row.placement) place.placement = *row.placement;
      made.rows.push_back(place);
    }
    planned_.push_back(std::move(made));
    if (watch.ms() >= ms || is_stale()) return;
  }
}

template <typename Show>
void LivePlan::for_each_row(int from, int to, const Show& show) const {
  for (int f = std::max(from, 0); f < std::min(to, planned()); ++f) {
    const FrameReport& report = planned_[f].report;
    for (const PlannedRow& place : planned_[f].rows)
      show(place.map >= 0 ? DecisionRow(report, report.shadow_maps[place.map])
                          : DecisionRow(report, report.plan.decisions[place.layer],
                                        place.placement ? &*place.placement : nullptr));
  }
}

Json LivePlan::rows(int from) const {
  ColumnLists<DecisionRow> decisions(decision_table(), kMapColumns);
  ColumnLists<FrameLine> lines(frame_table(), kCurveColumns);
  for_each_row(from, planned(), [&](const DecisionRow& row) { decisions.add(row); });
  for (int f = std::max(from, 0); f < planned(); ++f) lines.add(line_of(planned_[f].report));
  return {{"planned", planned()},
          {"frames", frames()},
          {"decisions", decisions.take()},
          {"frame_lines", lines.take()}};
}

/// What changed before the frame, by layer, as a line of changes.jsonl.
std::map<std::string, std::string> LivePlan::changes_of(int frame) const {
  std::map<std::string, std::string> lines;
  if (frame < 0 || frame >= planned()) return lines;
  LastRenders before;
  for (int f = 0; f < frame; ++f) before.note(planned_[f].report);
  for (const Change& change : changes_in(pipeline_, planned_[frame].report, before))
    lines[change.layer] = json_of(change);
  return lines;
}

Json LivePlan::frame(int frame) const {
  const std::vector<ColumnInfo> columns = live_columns();
  const std::map<std::string, std::string> changes = changes_of(frame);
  FlatLine decision(flat_columns(decision_table())), change(flat_columns(change_table()));
  std::vector<Json> lists(columns.size(), Json::array());
  for_each_row(frame, frame + 1, [&](const DecisionRow& row) {
    decision.read(json_of(row));
    const auto found = changes.find(row.name);
    change.read(found == changes.end() ? std::string() : found->second);
    std::size_t k = 0;
    for (const Cell& cell : decision.cells()) lists[k++].push_back(json_of_cell(cell));
    for (std::size_t c = kChangeKeys; c < change.cells().size(); ++c)
      lists[k++].push_back(json_of_cell(change.cells()[c]));
  });
  Json json = Json::object();
  for (std::size_t k = 0; k < columns.size(); ++k) json[columns[k].name] = std::move(lists[k]);
  return {{"frame", frame}, {"columns", std::move(json)}};
}

std::string LivePlan::lines() const {
  std::string text;
  for_each_row(0, planned(), [&](const DecisionRow& row) { text += json_of(row) + "\n"; });
  return text;
}

}  // namespace talisman::sequences
