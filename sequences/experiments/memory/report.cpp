// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <nlohmann/json.hpp>

#include "sequences/experiments/memory/measured.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using MemoryJson = nlohmann::ordered_json;

constexpr NamedValue<MemoryResult> kMemoryColumns[] = {
    {"prefetch_frames", [](const MemoryResult& r) { return double(r.setting.prefetch.frames); }},
    {"memory_mb", [](const MemoryResult& r) { return r.setting.limits.memory_mb; }},
    {"io_mb_per_s", [](const MemoryResult& r) { return r.setting.limits.io_mb_per_s; }},
    {"levels_skipped", [](const MemoryResult& r) { return r.skipped; }},
    {"levels_skipped_most", [](const MemoryResult& r) { return r.skipped_most; }},
    {"things_skipped", [](const MemoryResult& r) { return r.skipped_things; }},
    {"range_cells", [](const MemoryResult& r) { return r.range_cells; }},
    {"things_ahead", [](const MemoryResult& r) { return r.things; }},
    {"things_ahead_most", [](const MemoryResult& r) { return r.things_most; }},
    {"wanted_mb", [](const MemoryResult& r) { return r.wanted_mb; }},
    {"read_mb", [](const MemoryResult& r) { return r.read_mb; }},
    {"wasted_mb", [](const MemoryResult& r) { return r.wasted_mb; }},
    {"resident_most_mb", [](const MemoryResult& r) { return r.resident_most_mb; }},
};

std::string memory_csv(const MemoryExperiment& experiment) {
  std::string csv = "setting" + csv_names(kMemoryColumns) + "\n";
  for (const MemoryResult& r : experiment.results)
    csv += quoted(r.setting.group) + csv_cells(kMemoryColumns, r) + "\n";
  return csv;
}

std::string memory_json(const MemoryExperiment& experiment) {
  MemoryJson rows = MemoryJson::array();
  for (const MemoryResult& r : experiment.results) {
    MemoryJson row = {{"setting", r.setting.group}};
    put(row, kMemoryColumns, r);
    rows.push_back(std::move(row));
  }
  const MemoryJson json = {{"schema", "talisman.memory/1"},
                           {"sequence", experiment.sequence},
                           {"display_px", {experiment.display_px.x, experiment.display_px.y}},
                           {"first_frame", experiment.frames.first},
                           {"last_frame", experiment.frames.last},
                           {"things", experiment.things},
                           {"cells", experiment.cells},
                           {"polygons_of_all_levels", experiment.polygons},
                           {"total_mb", experiment.total_mb},
                           {"seen_things", experiment.seen},
                           {"seen_mb", experiment.seen_mb},
                           {"speed_m_per_s", experiment.speed_m_per_s},
                           {"turn_deg_per_s", experiment.turn_deg_per_s},
                           {"results", std::move(rows)}};
  return json.dump(1) + "\n";
}

PageTable memory_table(const MemoryExperiment& experiment) {
  PageTable table{{"setting", "N", "skipped", "most", "not drawn", "cells", "things", "most", "wanted MB",
                   "read MB", "wasted MB", "there MB"},
                  {},
                  1};
  for (const MemoryResult& r : experiment.results)
    table.rows.push_back({r.setting.group, std::to_string(r.setting.prefetch.frames), fixed(r.skipped, 2),
                          fixed(r.skipped_most, 0), fixed(r.skipped_things, 2), fixed(r.range_cells, 2),
                          fixed(r.things, 0), fixed(r.things_most, 0), fixed(r.wanted_mb, 2),
                          fixed(r.read_mb, 2), fixed(r.wasted_mb, 2), fixed(r.resident_most_mb, 2)});
  return table;
}

std::string memory_verdict(const MemoryExperiment& experiment) {
  const std::vector<double> skipped = skipped_over_depths(experiment, "by object");
  if (skipped.empty()) return {};
  if (*std::max_element(skipped.begin(), skipped.end()) == 0) return "Nothing is skipped with any N.";
  const auto least = std::min_element(skipped.begin(), skipped.end());
  return formatted("Least is skipped with N = %d: %.2f levels in a frame; %.2f with N = 1, %.2f with N = 64.",
                   kPrefetchDepths[least - skipped.begin()], *least, skipped.front(), skipped.back());
}

PlotSeries memory_series(const MemoryExperiment& experiment, const std::string& group,
                         double (*value)(const MemoryResult&)) {
  PlotSeries series{group, {}};
  for (const MemoryResult& r : experiment.results)
    if (r.setting.group == group) series.points.push_back({double(r.setting.prefetch.frames), value(r)});
  return series;
}

Plot over_depths(const MemoryExperiment& experiment, const std::string& title, const PlotAxis& axis,
                 double (*value)(const MemoryResult&)) {
  Plot plot{title + ", " + experiment.sequence, {"N", "frames ahead", true}, axis, {}};
  std::string last;
  for (const MemoryResult& r : experiment.results)
    if (r.setting.group != last)
      plot.series.push_back(memory_series(experiment, last = r.setting.group, value));
  return plot;
}

}  // namespace

void write_report(const MemoryExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/memory.csv", memory_csv(experiment));
  write_text_atomically(dir + "/memory.json", memory_json(experiment));
  write_plot(dir, "memory-skipped",
             over_depths(experiment, "levels skipped", {"levels skipped in a frame", "", false, true},
                         [](const MemoryResult& r) { return r.skipped; }));
  write_plot(dir, "memory-read",
             over_depths(experiment, "bytes read", {"read over the walk", "MB", false, true},
                         [](const MemoryResult& r) { return r.read_mb; }));
}

Page page_of(const MemoryExperiment& experiment) {
  Page page{"Memory: " + experiment.sequence, {}, memory_verdict(experiment), "memory.html"};
  page.blocks = {
      Paragraph{
          measured_on(experiment.sequence, experiment.frames, experiment.display_px) +
          formatted(", %d things in %d cells, flattened: %lld polygons of all levels, %.1f MB; in view "
                    "%.0f things that ask for %.2f MB. The eye moves by up to %.2f m and turns by up to "
                    "%.0f degrees a second. %g MB of memory, %g MB/s.",
                    experiment.things, experiment.cells, static_cast<long long>(experiment.polygons),
                    experiment.total_mb, experiment.seen, experiment.seen_mb, experiment.speed_m_per_s,
                    experiment.turn_deg_per_s, experiment.limits.memory_mb, experiment.limits.io_mb_per_s)},
      memory_table(experiment),
      Figure{"memory-skipped.svg", "Levels skipped in a frame over the frames looked ahead."},
      Figure{"memory-read.svg", "Bytes read over the frames looked ahead."}};
  return page;
}

}  // namespace talisman::sequences
