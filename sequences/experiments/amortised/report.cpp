// SPDX-License-Identifier: Apache-2.0
#include <ostream>

#include <nlohmann/json.hpp>

#include "sequences/experiments/amortised/measured.h"
#include "sequences/experiments/named_values.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr NamedValue<AmortisedResult> kAmortisedColumns[] = {
    {"layers", [](const AmortisedResult& r) { return double(r.layers); }},
    {"sprites_shown", [](const AmortisedResult& r) { return r.sprites; }},
    {"merges", [](const AmortisedResult& r) { return double(r.merges); }},
    {"splits", [](const AmortisedResult& r) { return double(r.splits); }},
    {"changes_above_ceiling", [](const AmortisedResult& r) { return double(r.above_ceiling); }},
    {"renders", [](const AmortisedResult& r) { return double(r.measured.renders); }},
    {"polygons", [](const AmortisedResult& r) { return double(r.measured.polygons); }},
    {"polygons_reference", [](const AmortisedResult& r) { return double(r.polygons_reference); }},
    {"planned_render_ms", [](const AmortisedResult& r) { return r.planned_render_ms; }},
    {"planned_composite_ms", [](const AmortisedResult& r) { return r.planned_composite_ms; }},
    {"planned_ms", [](const AmortisedResult& r) { return r.planned_ms(); }},
    {"modelled_frame_ms", [](const AmortisedResult& r) { return r.measured.modelled_ms; }},
    {"largest_px", [](const AmortisedResult& r) { return r.measured.max_geometric_px; }},
    {"psnr_db", [](const AmortisedResult& r) { return r.measured.quality.psnr_db; }},
    {"flip", [](const AmortisedResult& r) { return r.measured.quality.flip; }},
    {"popping_rms", [](const AmortisedResult& r) { return r.measured.popping.rms; }},
    {"wall_plan_ms", [](const AmortisedResult& r) { return r.measured.plan.mean; }},
    {"wall_render_ms", [](const AmortisedResult& r) { return r.measured.render.mean; }},
    {"wall_composite_ms", [](const AmortisedResult& r) { return r.measured.composite.mean; }},
};

std::string csv_of(const AmortisedExperiment& experiment) {
  std::string csv = "setting,grouping" + csv_names(kAmortisedColumns) + "\n";
  for (const AmortisedResult& result : experiment.results)
    csv += quoted(result.name) + "," + result.grouping + csv_cells(kAmortisedColumns, result) + "\n";
  return csv;
}

std::string json_of(const AmortisedExperiment& experiment) {
  Json rows = Json::array();
  for (const AmortisedResult& result : experiment.results) {
    Json row = {{"setting", result.name}, {"grouping", result.grouping}};
    put(row, kAmortisedColumns, result);
    rows.push_back(std::move(row));
  }
  const Json json = {{"schema", "talisman.amortised/1"},
                     {"sequence", experiment.sequence},
                     {"display_px", {experiment.display_px.x, experiment.display_px.y}},
                     {"first_frame", experiment.frames.first},
                     {"last_frame", experiment.frames.last},
                     {"quality_every", experiment.frames.every},
                     {"groupings_tried", experiment.groupings_tried},
                     {"left_out", experiment.left_out},
                     {"settings", std::move(rows)}};
  return json.dump(1) + "\n";
}

/// A point for each row: what a frame costs against how far the worst sprite is off.
Plot cost_plot(const AmortisedExperiment& experiment) {
  Plot plot{"who shares a sprite: " + experiment.sequence,
            {"sprites shown", "", false, true},
            {"a frame, modelled, as planned", "ms", false, true},
            {}};
  for (const AmortisedResult& r : experiment.results)
    plot.series.push_back({r.name, {{r.sprites, r.planned_ms()}}});
  return plot;
}

}  // namespace

void write_report(const AmortisedExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/amortised.csv", csv_of(experiment));
  write_text_atomically(dir + "/amortised.json", json_of(experiment));
  write_plot(dir, "amortised", cost_plot(experiment));
}

void print_report(const AmortisedExperiment& experiment, std::ostream& out) {
  PageTable table{{"layers", "", "shown", "merges", "splits", "above ceiling", "polygons %", "render ms",
                   "+ composite", "largest px", "PSNR dB", "FLIP", "pop", "plan", "draw", "composite ms"},
                  {},
                  1};
  for (const AmortisedResult& r : experiment.results)
    table.rows.push_back({r.name, std::to_string(r.layers), fixed(r.sprites, 1), std::to_string(r.merges),
                          std::to_string(r.splits), std::to_string(r.above_ceiling),
                          percent_of(double(r.measured.polygons), double(r.polygons_reference)),
                          fixed(r.planned_render_ms, 3), fixed(r.planned_ms(), 3),
                          fixed(r.measured.max_geometric_px, 3), fixed(r.measured.quality.psnr_db, 1),
                          fixed(r.measured.quality.flip, 4), fixed(r.measured.popping.rms, 2),
                          fixed(r.measured.plan.mean, 2), fixed(r.measured.render.mean, 2),
                          fixed(r.measured.composite.mean, 2)});
  out << experiment.sequence << ": frames " << experiment.frames.first << "-" << experiment.frames.last
      << ", one in " << experiment.frames.every << " drawn and compared with direct, "
      << experiment.display_px.x << "x" << experiment.display_px.y
      << " px. render, composite: modelled, mean of a frame; plan, draw, composite ms: this machine\n"
      << plain_text(table);
  if (experiment.groupings_tried > 0)
    out << "best of all groupings: of " << experiment.groupings_tried << " that were planned\n";
  if (!experiment.left_out.empty()) out << "left out: " << experiment.left_out << "\n";
}

}  // namespace talisman::sequences
