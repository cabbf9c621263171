// SPDX-License-Identifier: Apache-2.0

#include <nlohmann/json.hpp>

#include "sequences/experiments/amortised/measured.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
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

PageTable amortised_table(const AmortisedExperiment& experiment) {
  PageTable table{{"layers", "of", "shown", "merges", "splits", "above ceiling", "polygons %", "render ms",
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
  return table;
}

/// The cheapest that is no floor, beside the author's own.
std::string verdict_on(const AmortisedExperiment& experiment) {
  const AmortisedResult *cheapest = nullptr, *own = nullptr;
  for (const AmortisedResult& r : experiment.results) {
    if (r.name == "author's layers") own = &r;
    if (r.grouping != "best" && (!cheapest || r.planned_ms() < cheapest->planned_ms())) cheapest = &r;
  }
  if (!cheapest || !own) return {};
  return "Cheapest: " + cheapest->name + ", " + fixed(cheapest->planned_ms(), 3) +
         " ms a frame as planned, with an error of at most " + fixed(cheapest->measured.max_geometric_px, 3) +
         " px; the author's layers take " + fixed(own->planned_ms(), 3) + " ms.";
}

}  // namespace

void write_report(const AmortisedExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/amortised.csv", csv_of(experiment));
  write_text_atomically(dir + "/amortised.json", json_of(experiment));
  write_plot(dir, "amortised", cost_plot(experiment));
}

Page page_of(const AmortisedExperiment& experiment) {
  Page page{"Who shares a sprite: " + experiment.sequence, {}, verdict_on(experiment), "amortised.html"};
  page.blocks = {
      Paragraph{measured_on(experiment.sequence, experiment.frames, experiment.display_px) +
                "; one frame in " + std::to_string(experiment.frames.every) +
                " drawn and compared with direct. render, composite: modelled, mean of a frame; plan, draw, "
                "composite ms: this machine"},
      amortised_table(experiment)};
  if (experiment.groupings_tried > 0)
    page.blocks.push_back(Paragraph{"best of all groupings: of " +
                                    std::to_string(experiment.groupings_tried) + " that were planned"});
  if (!experiment.left_out.empty()) page.blocks.push_back(Paragraph{"left out: " + experiment.left_out});
  page.blocks.push_back(
      Figure{"amortised.svg", "What a frame costs, modelled, against the sprites that it shows."});
  return page;
}

}  // namespace talisman::sequences
