// SPDX-License-Identifier: Apache-2.0

#include <nlohmann/json.hpp>

#include "sequences/experiments/culling/visibility.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using VisibilityJson = nlohmann::ordered_json;

constexpr NamedValue<VisibilityResult> kVisibilityColumns[] = {
    {"polygons", [](const VisibilityResult& r) { return r.polygons; }},
    {"polygons_most", [](const VisibilityResult& r) { return r.polygons_most; }},
    {"parts", [](const VisibilityResult& r) { return r.parts; }},
    {"cells", [](const VisibilityResult& r) { return r.cells; }},
    {"first_ms", [](const VisibilityResult& r) { return r.first_ms; }},
    {"decide_ms", [](const VisibilityResult& r) { return r.decide_ms; }},
    {"decide_most_ms", [](const VisibilityResult& r) { return r.decide_most_ms; }},
    {"render_ms", [](const VisibilityResult& r) { return r.render_ms; }},
    {"frames_in_walls", [](const VisibilityResult& r) { return double(r.in_walls); }},
    {"frames_drawn", [](const VisibilityResult& r) { return double(r.drawn); }},
    {"frames_differing", [](const VisibilityResult& r) { return double(r.differing); }},
};

std::string csv_of(const VisibilityExperiment& experiment) {
  std::string csv = "visibility" + csv_names(kVisibilityColumns) + "\n";
  for (const VisibilityResult& r : experiment.results)
    csv += quoted(text_of(r.options)) + csv_cells(kVisibilityColumns, r) + "\n";
  return csv;
}

std::string json_of(const VisibilityExperiment& experiment) {
  VisibilityJson rows = VisibilityJson::array();
  for (const VisibilityResult& r : experiment.results) {
    VisibilityJson row = {{"visibility", text_of(r.options)}};
    put(row, kVisibilityColumns, r);
    rows.push_back(std::move(row));
  }
  const VisibilityJson json = {{"schema", "talisman.visibility/1"},
                               {"sequence", experiment.sequence},
                               {"display_px", {experiment.display_px.x, experiment.display_px.y}},
                               {"first_frame", experiment.frames.first},
                               {"last_frame", experiment.frames.last},
                               {"polygons", experiment.polygons},
                               {"parts", experiment.parts},
                               {"cells", experiment.cells},
                               {"portals", experiment.portals},
                               {"results", std::move(rows)}};
  return json.dump(1) + "\n";
}

PageTable visibility_table(const VisibilityExperiment& experiment) {
  PageTable table{{"visibility", "polygons", "%", "most", "parts", "cells", "first ms", "decide ms",
                   "most ms", "draw ms", "differing", "of"},
                  {},
                  1};
  for (const VisibilityResult& r : experiment.results)
    table.rows.push_back({text_of(r.options), fixed(r.polygons, 0),
                          percent_of(r.polygons, double(experiment.polygons)), fixed(r.polygons_most, 0),
                          fixed(r.parts, 1), fixed(r.cells, 1), fixed(r.first_ms, 3), fixed(r.decide_ms, 3),
                          fixed(r.decide_most_ms, 3), fixed(r.render_ms, 1), std::to_string(r.differing),
                          std::to_string(r.drawn)});
  return table;
}

/// What leaves least, and whether all pictures are as without.
std::string verdict_on(const VisibilityExperiment& experiment) {
  const VisibilityResult* least = nullptr;
  int drawn = 0, differing = 0;
  for (const VisibilityResult& r : experiment.results) {
    if (!least || r.polygons < least->polygons) least = &r;
    drawn += r.drawn, differing += r.differing;
  }
  if (!least) return {};
  return "Least is left by " + text_of(least->options) + ": " +
         percent_of(least->polygons, double(experiment.polygons)) + " % of the polygons, decided in " +
         fixed(least->decide_ms, 3) + " ms; of " + std::to_string(drawn) + " pictures " +
         (differing == 0 ? "none" : std::to_string(differing)) + " differ from those without.";
}

}  // namespace

void write_report(const VisibilityExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/visibility.csv", csv_of(experiment));
  write_text_atomically(dir + "/visibility.json", json_of(experiment));
  Plot plot{"what is left, and what finding it costs, " + experiment.sequence,
            {"polygons left", "", true},
            {"deciding", "ms", true},
            {}};
  for (const VisibilityResult& r : experiment.results)
    plot.series.push_back({text_of(r.options), {{r.polygons, r.decide_ms}}});
  write_plot(dir, "visibility", plot);
}

Page page_of(const VisibilityExperiment& experiment) {
  Page page{"What can be seen: " + experiment.sequence, {}, verdict_on(experiment), "visibility.html"};
  page.blocks = {Paragraph{measured_on(experiment.sequence, experiment.frames, experiment.display_px) +
                           formatted(", %lld polygons, %d parts, %d cells, %d portals",
                                     static_cast<long long>(experiment.polygons), experiment.parts,
                                     experiment.cells, experiment.portals)},
                 visibility_table(experiment),
                 Figure{"visibility.svg", "Time to decide a frame against the polygons left."}};
  return page;
}

}  // namespace talisman::sequences
