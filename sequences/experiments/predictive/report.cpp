// SPDX-License-Identifier: Apache-2.0

#include <nlohmann/json.hpp>

#include "sequences/experiments/named_values.h"
#include "sequences/experiments/predictive/measured.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr NamedValue<PredictiveResult> kPredictiveColumns[] = {
    {"knob", [](const PredictiveResult& r) { return r.setting.value; }},
    {"draws", [](const PredictiveResult& r) { return double(r.draws); }},
    {"shown", [](const PredictiveResult& r) { return double(r.shown); }},
    {"polygons", [](const PredictiveResult& r) { return double(r.polygons); }},
    {"polygons_reference", [](const PredictiveResult& r) { return double(r.polygons_reference); }},
    {"joins", [](const PredictiveResult& r) { return double(r.joins); }},
    {"joins_empty", [](const PredictiveResult& r) { return double(r.joins_empty); }},
    {"pixels_joined_per_frame", [](const PredictiveResult& r) { return r.pixels_joined; }},
    {"pixels_cleared_per_frame", [](const PredictiveResult& r) { return r.pixels_cleared; }},
    {"bytes_held", [](const PredictiveResult& r) { return double(r.bytes); }},
    {"largest_px", [](const PredictiveResult& r) { return r.largest_px; }},
    {"psnr_db", [](const PredictiveResult& r) { return r.quality.psnr_db; }},
    {"ssim", [](const PredictiveResult& r) { return r.quality.ssim; }},
    {"flip", [](const PredictiveResult& r) { return r.quality.flip; }},
    {"popping_rms", [](const PredictiveResult& r) { return r.popping_rms; }},
    {"modelled_ms", [](const PredictiveResult& r) { return r.modelled_ms; }},
    {"modelled_joining_ms", [](const PredictiveResult& r) { return r.modelled_joining_ms; }},
    {"wall_plan_ms", [](const PredictiveResult& r) { return r.plan_ms; }},
    {"wall_render_ms", [](const PredictiveResult& r) { return r.render_ms; }},
    {"wall_composite_ms", [](const PredictiveResult& r) { return r.composite_ms; }},
    {"wall_frame_ms", [](const PredictiveResult& r) { return r.frame_ms(); }},
};

std::string csv_of(const PredictiveExperiment& experiment) {
  std::string csv = "setting,series" + csv_names(kPredictiveColumns) + "\n";
  for (const PredictiveResult& result : experiment.results)
    csv += quoted(result.setting.name) + "," + result.setting.series + csv_cells(kPredictiveColumns, result) +
           "\n";
  return csv;
}

std::string json_of(const PredictiveExperiment& experiment) {
  Json rows = Json::array();
  for (const PredictiveResult& result : experiment.results) {
    Json row = {{"setting", result.setting.name}, {"series", result.setting.series}};
    put(row, kPredictiveColumns, result);
    rows.push_back(std::move(row));
  }
  const Json json = {{"schema", "talisman.predictive/1"},
                     {"sequence", experiment.sequence},
                     {"display_px", {experiment.display_px.x, experiment.display_px.y}},
                     {"samples", experiment.samples},
                     {"first_frame", experiment.frames.first},
                     {"last_frame", experiment.frames.last},
                     {"quality_every", experiment.frames.every},
                     {"settings", std::move(rows)}};
  return json.dump(1) + "\n";
}

/// Polygons drawn against the displayed error, of all policies that have a bound.
Plot polygons_plot(const PredictiveExperiment& experiment) {
  Plot plot{"what a bound costs: shared buffers and sprites, " + experiment.sequence,
            {"bound", "px", true},
            {"polygons drawn, of those of reference", "%", false, true},
            {}};
  for (const char* series : {"delta", "threshold", "lookahead", "oracle"}) {
    PlotSeries line{std::string(series) == "delta" ? "predictive" : series, {}};
    for (const PredictiveResult& r : experiment.results)
      if (r.setting.series == series && r.polygons_reference > 0)
        line.points.push_back({r.setting.value, 100.0 * double(r.polygons) / double(r.polygons_reference)});
    plot.series.push_back(std::move(line));
  }
  return plot;
}

Plot slices_plot(const PredictiveExperiment& experiment) {
  Plot plot{"how far to look ahead: " + experiment.sequence,
            {"N", "frames", true},
            {"time", "ms", false, true},
            {}};
  PlotSeries plan{"plan", {}}, render{"draw and join", {}}, modelled{"modelled, joining included", {}};
  for (const PredictiveResult& r : experiment.results) {
    if (r.setting.series != "N") continue;
    plan.points.push_back({r.setting.value, r.plan_ms});
    render.points.push_back({r.setting.value, r.render_ms});
    modelled.points.push_back({r.setting.value, r.modelled_ms + r.modelled_joining_ms});
  }
  plot.series = {plan, render, modelled};
  return plot;
}

PageTable predictive_table(const PredictiveExperiment& experiment) {
  PageTable table{{"setting", "draws", "of", "polygons %", "joined px", "MB held", "largest px", "PSNR dB",
                   "FLIP", "pop", "modelled ms", "joining ms", "plan ms", "draw ms", "composite ms"},
                  {},
                  1};
  for (const PredictiveResult& r : experiment.results)
    table.rows.push_back({r.setting.name, std::to_string(r.draws), std::to_string(r.shown),
                          percent_of(double(r.polygons), double(r.polygons_reference)),
                          fixed(r.pixels_joined, 0), fixed(double(r.bytes) / 1e6, 2), fixed(r.largest_px, 3),
                          fixed(r.quality.psnr_db, 1), fixed(r.quality.flip, 4), fixed(r.popping_rms, 2),
                          fixed(r.modelled_ms, 2), fixed(r.modelled_joining_ms, 2), fixed(r.plan_ms, 2),
                          fixed(r.render_ms, 2), fixed(r.composite_ms, 2)});
  return table;
}

/// Polygons under one bound of 1 px.
std::string verdict_on(const PredictiveExperiment& experiment) {
  std::string text;
  for (const char* series : {"delta", "threshold", "lookahead", "oracle"})
    for (const PredictiveResult& r : experiment.results)
      if (r.setting.series == series && r.setting.value == 1)
        text += std::string(text.empty() ? "Under a bound of 1 px: " : ", ") +
                (std::string(series) == "delta" ? "predictive" : series) + " draws " +
                percent_of(double(r.polygons), double(r.polygons_reference)) + " %";
  return text.empty() ? text : text + " of the polygons of reference.";
}

}  // namespace

void write_report(const PredictiveExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/predictive.csv", csv_of(experiment));
  write_text_atomically(dir + "/predictive.json", json_of(experiment));
  write_plot(dir, "predictive-bound", polygons_plot(experiment));
  write_plot(dir, "predictive-slices", slices_plot(experiment));
}

Page page_of(const PredictiveExperiment& experiment) {
  Page page{
      "Buffers that parts share: " + experiment.sequence, {}, verdict_on(experiment), "predictive.html"};
  page.blocks = {
      Paragraph{measured_on(experiment.sequence, experiment.frames, experiment.display_px) +
                formatted("; one frame in %d drawn and compared with direct, %d samples for each pixel",
                          experiment.frames.every, experiment.samples)},
      predictive_table(experiment),
      Figure{"predictive-bound.svg", "Polygons drawn over the bound of the displayed error."},
      Figure{"predictive-slices.svg", "Time of a frame over how far ahead it looks."}};
  return page;
}

}  // namespace talisman::sequences
