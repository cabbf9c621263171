// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/comparison/report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/setting_file.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/folders.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr NamedValue<Compared> kCompared[] = {
    {"frames", [](const Compared& c) { return double(c.summary.frames.size()); }},
    {"mean_update_rate", [](const Compared& c) { return c.result.mean_update_rate; }},
    {"weighted_update_rate", [](const Compared& c) { return c.result.weighted_update_rate; }},
    {"renders", [](const Compared& c) { return double(c.result.renders); }},
    {"polygons", [](const Compared& c) { return double(c.result.polygons); }},
    {"pixels", [](const Compared& c) { return double(c.result.pixels); }},
    {"chunks", [](const Compared& c) { return double(c.result.chunks); }},
    {"mean_geometric_px", [](const Compared& c) { return c.result.mean_geometric_px; }},
    {"max_geometric_px", [](const Compared& c) { return c.result.max_geometric_px; }},
    {"modelled_ms", [](const Compared& c) { return c.result.modelled_ms; }},
    {"worst_modelled_ms", [](const Compared& c) { return c.worst_modelled_ms; }},
    {"mean_psnr_db", [](const Compared& c) { return c.quality.mean.psnr_db; }},
    {"worst_psnr_db", [](const Compared& c) { return c.quality.worst.psnr_db; }},
    {"mean_ssim", [](const Compared& c) { return c.quality.mean.ssim; }},
    {"worst_ssim", [](const Compared& c) { return c.quality.worst.ssim; }},
    {"mean_flip", [](const Compared& c) { return c.quality.mean.flip; }},
    {"worst_flip", [](const Compared& c) { return c.quality.worst.flip; }},
    {"popping_rms", [](const Compared& c) { return c.result.popping.rms; }},
    {"popping_p95", [](const Compared& c) { return c.result.popping.p95; }},
    {"elsewhere_rms", [](const Compared& c) { return c.result.popping.elsewhere_rms; }},
    {"wall_plan_ms", [](const Compared& c) { return c.result.plan.mean; }},
    {"wall_render_ms", [](const Compared& c) { return c.result.render.mean; }},
    {"wall_composite_ms", [](const Compared& c) { return c.result.composite.mean; }},
};

std::string psnr_text(double psnr_db) { return std::isfinite(psnr_db) ? fixed(psnr_db, 2) : "identical"; }

PageTable comparison_table(const ComparisonReport& report) {
  PageTable table{{"setting", "rate %", "polygons %", "pixels %", "model ms", "worst ms", "PSNR dB",
                   "worst dB", "FLIP", "worst", "popping", "wall ms"},
                  {},
                  1};
  const SettingResult& reference = report.compared.front().result;
  for (const Compared& c : report.compared)
    table.rows.push_back({c.name, fixed(100 * c.result.mean_update_rate, 1),
                          percent_of(double(c.result.polygons), double(reference.polygons)),
                          percent_of(double(c.result.pixels), double(reference.pixels)),
                          fixed(c.result.modelled_ms, 2), fixed(c.worst_modelled_ms, 2),
                          psnr_text(c.quality.mean.psnr_db), psnr_text(c.quality.worst.psnr_db),
                          fixed(c.quality.mean.flip, 5), fixed(c.quality.worst.flip, 5),
                          fixed(c.result.popping.rms, 2), fixed(c.result.frame_ms(), 1)});
  return table;
}

PlotSeries errors(const ComparisonReport& report, const char* name, double Quality::*quantity,
                  const Quality DiffSummary::*which) {
  PlotSeries series{name, {}, SeriesStyle::Points, {}};
  for (const Compared& c : report.compared) {
    if (&c == &report.compared.front()) continue;
    series.points.push_back({c.result.modelled_ms, c.quality.*which.*quantity});
    series.labels.push_back(c.name);
  }
  return series;
}

void write_runs(const ComparisonReport& report, const std::string& dir) {
  prepare_folder(dir);
  for (const Compared& c : report.compared) {
    std::string lines;
    for (const FrameLine& line : c.summary.frames) lines += json_of(line) + "\n";
    const std::string base = dir + "/" + file_name_of(c.name);
    write_text_atomically(base + ".frames.jsonl", lines);
    write_text_atomically(base + ".summary.json", json_of(c.summary));
  }
}

/// The cheapest, and the nearest to the truth.
std::string verdict_on(const ComparisonReport& report) {
  const Compared *cheapest = nullptr, *nearest = nullptr;
  for (const Compared& c : report.compared) {
    if (&c == &report.compared.front()) continue;
    if (!cheapest || c.result.modelled_ms < cheapest->result.modelled_ms) cheapest = &c;
    if (!nearest || c.quality.mean.flip < nearest->quality.mean.flip) nearest = &c;
  }
  if (!cheapest) return {};
  const auto words = [&](const Compared& c) {
    return c.name + " (" + fixed(c.result.modelled_ms, 2) + " ms a frame, FLIP " +
           fixed(c.quality.mean.flip, 5) + ")";
  };
  const std::string both =
      cheapest == nearest ? "Cheapest and nearest to the truth: " + words(*cheapest)
                          : "Cheapest: " + words(*cheapest) + "; nearest to the truth: " + words(*nearest);
  return both + "; reference takes " + fixed(report.compared.front().result.modelled_ms, 2) + " ms.";
}

}  // namespace

std::string compare_csv(const ComparisonReport& report) {
  std::string csv = "setting" + csv_names(kCompared) + "\n";
  for (const Compared& c : report.compared) csv += quoted(c.name) + csv_cells(kCompared, c) + "\n";
  return csv;
}

std::string json_of(const ComparisonReport& report) {
  Json settings = Json::array();
  for (const Compared& c : report.compared) {
    Json json{{"setting", c.name}};
    put(json, kCompared, c);
    settings.push_back(json);
  }
  const Json json{{"schema", "talisman.compare/1"},
                  {"sequence", report.sequence},
                  {"display_px", {report.display_px.x, report.display_px.y}},
                  {"first_frame", report.frames.first},
                  {"last_frame", report.frames.last},
                  {"complete", !report.is_stopped},
                  {"settings", settings}};
  return json.dump(1) + "\n";
}

Plot cost_plot(const ComparisonReport& report) {
  Plot plot{"picture error against modelled time of a frame (" + report.sequence + ")",
            {"modelled time of a frame, mean", "ms", false},
            {"FLIP against reference: less is better", "", true},
            {}};
  plot.series = {errors(report, "worst frame", &Quality::flip, &DiffSummary::worst),
                 errors(report, "mean", &Quality::flip, &DiffSummary::mean)};
  double lo = HUGE_VAL, hi = 0;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points)
      if (point.y > 0) lo = std::min(lo, point.y), hi = std::max(hi, point.y);
  // An error of 0 has no place on a logarithmic axis.
  const double full_ms = report.compared.front().result.modelled_ms;
  if (hi > 0)
    plot.series.push_back({"reference: no error", {{full_ms, lo}, {full_ms, hi}}, SeriesStyle::Line, {}});
  return plot;
}

Plot frames_plot(const ComparisonReport& report) {
  Plot plot{"picture error over time (" + report.sequence + ")",
            {"frame", "", false},
            {"FLIP against reference: less is better", "", false},
            {}};
  for (const Compared& c : report.compared) {
    if (&c == &report.compared.front()) continue;
    PlotSeries series{c.name, {}, SeriesStyle::Line, {}};
    for (std::size_t k = 0; k < c.flip.size(); ++k)
      series.points.push_back({double(report.frames.first) + double(k), c.flip[k]});
    plot.series.push_back(series);
  }
  return plot;
}

void write_report(const ComparisonReport& report, const std::string& dir) {
  write_text_atomically(dir + "/compare.csv", compare_csv(report));
  write_text_atomically(dir + "/compare.json", json_of(report));
  write_runs(report, dir + "/runs");
  if (report.compared.empty()) return;
  write_plot(dir, "compare-cost", cost_plot(report), kLargePlot);
  write_plot(dir, "compare-frames", frames_plot(report), kLargePlot);
}

Page page_of(const ComparisonReport& report) {
  if (report.compared.empty()) return {};
  return {"Settings side by side: " + report.sequence,
          {Paragraph{measured_on(report.sequence, report.frames, report.display_px) +
                     "; polygons and pixels in % of reference, times per frame, errors against reference"},
           comparison_table(report),
           Figure{"compare-cost.svg", "Picture error against modelled time of a frame."},
           Figure{"compare-frames.svg", "Picture error over time."}},
          verdict_on(report),
          "compare.html"};
}

}  // namespace talisman::sequences
