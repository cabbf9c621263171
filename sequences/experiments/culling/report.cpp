// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "sequences/experiments/culling/measured.h"
#include "sequences/experiments/named_values.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using CullingJson = nlohmann::ordered_json;

constexpr NamedValue<CullingResult> kCullingColumns[] = {
    {"parts", [](const CullingResult& r) { return double(r.parts); }},
    {"moving_share", [](const CullingResult& r) { return r.moving_share; }},
    {"build_us", [](const CullingResult& r) { return r.build_us; }},
    {"update_us", [](const CullingResult& r) { return r.update_us; }},
    {"query_us", [](const CullingResult& r) { return r.query_us; }},
    {"found", [](const CullingResult& r) { return r.found; }},
    {"nodes", [](const CullingResult& r) { return r.nodes; }},
    {"tests", [](const CullingResult& r) { return r.tests; }},
    {"tests_spared", [](const CullingResult& r) { return r.spared; }},
    {"missed", [](const CullingResult& r) { return double(r.missed); }},
};

std::string csv_of(const CullingExperiment& experiment) {
  std::string csv = "workload,structure" + csv_names(kCullingColumns) + "\n";
  for (const CullingResult& r : experiment.results)
    csv += quoted(r.workload) + "," + quoted(r.structure) + csv_cells(kCullingColumns, r) + "\n";
  return csv;
}

std::string json_of(const CullingExperiment& experiment) {
  CullingJson rows = CullingJson::array();
  for (const CullingResult& r : experiment.results) {
    CullingJson row = {{"workload", r.workload}, {"structure", r.structure}};
    put(row, kCullingColumns, r);
    rows.push_back(std::move(row));
  }
  const CullingJson json = {{"schema", "talisman.culling/1"},
                            {"sequence", experiment.sequence},
                            {"display_px", {experiment.display_px.x, experiment.display_px.y}},
                            {"frames", experiment.frames},
                            {"results", std::move(rows)}};
  return json.dump(1) + "\n";
}

/// A line for each structure over those copies that `takes` one.
template <typename Takes, typename Value>
Plot plot_of(const CullingExperiment& experiment, const std::string& title, const PlotAxis& axis,
             const Takes& takes, const Value& value) {
  Plot plot{title + ", " + experiment.sequence, axis, {"update and query", "us", true}, {}};
  std::map<std::string, PlotSeries> lines;
  for (const CullingResult& r : experiment.results) {
    if (r.workload != "copies" || !takes(r)) continue;
    PlotSeries& line = lines[r.structure];
    line.name = r.structure;
    line.points.push_back({value(r), r.frame_us()});
  }
  for (auto& [name, line] : lines) plot.series.push_back(std::move(line));
  return plot;
}

PageTable culling_table(const CullingExperiment& experiment) {
  const std::vector<const CullingResult*> best = fastest(experiment);
  PageTable table{{"parts", "moving %", "structure", "build us", "update us", "query us", "found", "nodes",
                   "tests", "spared", "missed", "best"},
                  {},
                  1};
  for (const CullingResult& r : experiment.results)
    table.rows.push_back({std::to_string(r.parts), fixed(100 * r.moving_share, 1), r.structure,
                          fixed(r.build_us, 0), fixed(r.update_us, 1), fixed(r.query_us, 1),
                          fixed(r.found, 1), fixed(r.nodes, 1), fixed(r.tests, 1), fixed(r.spared, 1),
                          std::to_string(r.missed),
                          std::find(best.begin(), best.end(), &r) != best.end() ? "fastest" : ""});
  return table;
}

/// How often each is the fastest, and whether any missed a part.
std::string verdict_on(const CullingExperiment& experiment) {
  std::map<std::string, int> wins;
  for (const CullingResult* best : fastest(experiment)) ++wins[best->structure];
  std::string text = "Fastest:";
  for (const auto& [structure, count] : wins)
    text += (text.back() == ':' ? " " : ", ") + structure + " in " + std::to_string(count);
  std::int64_t missed = 0;
  for (const CullingResult& r : experiment.results) missed += r.missed;
  return text + " of " + std::to_string(fastest(experiment).size()) + " workloads; " +
         (missed == 0 ? std::string("none misses a part.") : std::to_string(missed) + " parts are missed.");
}

}  // namespace

void write_report(const CullingExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/culling.csv", csv_of(experiment));
  write_text_atomically(dir + "/culling.json", json_of(experiment));
  write_plot(dir, "culling-parts",
             plot_of(
                 experiment, "what is in view, of which 1 % moves", {"parts", "", true},
                 [](const CullingResult& r) { return r.moving_share == 0.01; },
                 [](const CullingResult& r) { return double(r.parts); }));
  write_plot(dir, "culling-moving",
             plot_of(
                 experiment, "what is in view of 10,000 parts", {"parts that move", "%"},
                 [](const CullingResult& r) { return r.parts == 10'000; },
                 [](const CullingResult& r) { return 100 * r.moving_share; }));
}

Page page_of(const CullingExperiment& experiment) {
  Page page{"What finds what is in view: " + experiment.sequence, {}, verdict_on(experiment), "culling.html"};
  page.blocks = {Paragraph{formatted("%s: %d frames, %dx%d px; the sequence's own parts, and copies of them",
                                     experiment.sequence.c_str(), experiment.frames, experiment.display_px.x,
                                     experiment.display_px.y)},
                 culling_table(experiment),
                 Figure{"culling-parts.svg", "Time of a frame over the number of parts, of which 1 % move."},
                 Figure{"culling-moving.svg", "Time of a frame over the share that moves, of 10,000 parts."}};
  return page;
}

}  // namespace talisman::sequences
