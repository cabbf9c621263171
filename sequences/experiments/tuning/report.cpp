// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Of its pictures; without any: none.
struct ShownQuality {
  double worst = NAN, mean = NAN;  ///< as they are printed; the mean of a setting that was drawn whole alone
};

/// How the pictures of a report are measured.
TuneGoal measure_of(const TuneReport& report) {
  return report.goal.is_of_pictures() ? report.goal : TuneGoal{GoalKind::Flip, 1, false};
}

ShownQuality measured_of(const TuneReport& report, const TunePoint& point) {
  const std::vector<double> known = point.quality.known();
  if (known.empty()) return {};
  const TuneGoal goal = measure_of(report);
  return {goal.shown(worst_of(known)), point.quality.is_whole() ? goal.shown(mean_of(known)) : NAN};
}

/// A bound has its sign: the rest of the frames may be worse.
std::string worst_text(const TuneReport& report, const TunePoint& point) {
  const std::vector<double> known = point.quality.known();
  if (known.empty()) return "-";
  const TuneGoal goal = measure_of(report);
  const bool is_bound = !point.quality.is_whole();
  const char* sign = !is_bound ? "" : goal.kind == GoalKind::Psnr ? "<= " : ">= ";
  return sign + goal.text_of(worst_of(known));
}

std::string mean_text(const TuneReport& report, const TunePoint& point) {
  if (point.quality.badness.empty() || !point.quality.is_whole()) return "-";
  return measure_of(report).text_of(mean_of(point.quality.badness));
}

std::string drawn_text(const TuneReport& report, const TunePoint& point) {
  const int drawn = point.quality.frames_drawn;
  if (drawn == 0) return "planned";
  return point.quality.is_whole() ? "measured" : formatted("%d of %d frames", drawn, report.frames());
}

bool is_answer(const TuneReport& report, const TunePoint& point) {
  return report.common && report.common->point.plan.thresholds == point.plan.thresholds;
}

std::vector<std::string> row_of(const TuneReport& report, const TunePoint& point, const std::string& name) {
  return {name,
          fixed(100 * report.cost_share(point.plan), 1),
          fixed(worst_of(point.plan.frame_ms), 2),
          fixed(mean_of(point.plan.frame_ms), 2),
          worst_text(report, point),
          mean_text(report, point),
          drawn_text(report, point)};
}

/// Every so many of the grid, and those next to the answer.
PageTable curve_table(const TuneReport& report) {
  constexpr int kEvery = 6, kBeside = 2;
  const std::string what = measure_of(report).quantity();
  PageTable table{
      {"threshold px", "cost %", "worst ms", "mean ms", "worst " + what, "mean " + what, "known from"},
      {},
      1};
  int answer = -1;
  for (int k = 0; k < static_cast<int>(report.curve.size()); ++k)
    if (is_answer(report, report.curve[k])) answer = k;
  for (int k = 0; k < static_cast<int>(report.curve.size()); ++k) {
    const bool is_near = answer >= 0 && std::abs(k - answer) <= kBeside;
    if (k % kEvery != 0 && !is_near && k + 1 != static_cast<int>(report.curve.size())) continue;
    const TunePoint& point = report.curve[k];
    table.rows.push_back(row_of(
        report, point, formatted("%g", point.plan.thresholds.geometric_px) + (k == answer ? " *" : "")));
  }
  return table;
}

/// What differs from the sequence's own weights.
std::vector<std::size_t> moved_layers(const TuneReport& report, const TunePoint& point) {
  std::vector<std::size_t> moved;
  for (std::size_t k = 0; k < point.plan.thresholds.weights.size(); ++k)
    if (point.plan.thresholds.weights[k] != report.given_weights[k]) moved.push_back(k);
  return moved;
}

std::string answer_line(const TuneReport& report, const TuneAnswer& answer) {
  const TuneGoal goal = measure_of(report);
  std::string line = "worst " + goal.quantity() + " " + worst_text(report, answer.point) + ", mean " +
                     mean_text(report, answer.point) + ", of " + std::to_string(report.frames()) +
                     (answer.point.quality.is_whole() ? " frames drawn" : " frames, not all drawn");
  return line + "; modelled drawing " + fixed(mean_of(answer.point.plan.frame_ms), 2) +
         " ms a frame, at most " + fixed(worst_of(answer.point.plan.frame_ms), 2) + " ms, " +
         fixed(100 * report.cost_share(answer.point.plan), 1) + " % of reference";
}

Json json_of_point(const TuneReport& report, const TunePoint& point) {
  const ShownQuality measured = measured_of(report, point);
  Json json{{"geometric_px", point.plan.thresholds.geometric_px},
            {"cost_share", number_or_null(report.cost_share(point.plan))},
            {"worst_ms", worst_of(point.plan.frame_ms)},
            {"mean_ms", mean_of(point.plan.frame_ms)},
            {"frames_drawn", point.quality.frames_drawn},
            {"is_bound", !point.quality.badness.empty() && !point.quality.is_whole()}};
  const char* unit = report.goal.kind == GoalKind::Psnr ? "psnr_db" : "flip";
  json[std::string("worst_") + unit] = number_or_null(measured.worst);
  json[std::string("mean_") + unit] = number_or_null(measured.mean);
  return json;
}

Json json_of_answer(const TuneReport& report, const std::optional<TuneAnswer>& answer) {
  if (!answer) return nullptr;
  Json json = json_of_point(report, answer->point);
  json["holds"] = answer->holds;
  Json layers = Json::array();
  for (const std::size_t k : moved_layers(report, answer->point)) {
    const double weight = answer->point.plan.thresholds.weights[k];
    layers.push_back({{"layer", report.layers[k]},
                      {"importance_geometric", weight},
                      {"threshold_px", number_or_null(answer->point.plan.thresholds.geometric_px / weight)}});
  }
  json["layers"] = layers;
  json["yaml"] = yaml_of(report, answer->point);
  return json;
}

/// Labels stand where there is room beside the one before.
PlotSeries series_of_quality(const TuneReport& report, const std::string& name, bool whole, bool of_mean) {
  constexpr double kRoomOfLabel_percent = 6;
  PlotSeries series{name, {}, SeriesStyle::Points, {}};
  double labelled = HUGE_VAL;
  for (const TunePoint& point : report.curve) {
    if (point.quality.frames_drawn == 0 || point.quality.is_whole() != whole) continue;
    const ShownQuality measured = measured_of(report, point);
    const double cost = 100 * report.cost_share(point.plan);
    series.points.push_back({cost, of_mean ? measured.mean : measured.worst});
    const bool has_room = !of_mean && std::abs(cost - labelled) > kRoomOfLabel_percent;
    series.labels.push_back(has_room ? formatted("%g px", point.plan.thresholds.geometric_px)
                                     : std::string());
    if (has_room) labelled = cost;
  }
  return series;
}

PlotSeries goal_line(const TuneReport& report, double first, double last) {
  return {"goal", {{first, report.goal.limit}, {last, report.goal.limit}}, SeriesStyle::Line, {}};
}

Plot time_plot_of(const TuneReport& report) {
  Plot plot{"modelled drawing time of a frame against the threshold (" + report.sequence + ")",
            {"threshold of the geometric fiducial", "px", true},
            {"modelled drawing time of a frame", "ms", true},
            {}};
  PlotSeries worst{"worst frame", {}, SeriesStyle::LinePoints, {}},
      mean{"mean", {}, SeriesStyle::LinePoints, {}};
  for (const TunePoint& point : report.curve) {
    worst.points.push_back({point.plan.thresholds.geometric_px, worst_of(point.plan.frame_ms)});
    mean.points.push_back({point.plan.thresholds.geometric_px, mean_of(point.plan.frame_ms)});
  }
  plot.series = {worst, mean};
  if (report.curve.size() > 1)
    plot.series.push_back(goal_line(report, report.curve[1].plan.thresholds.geometric_px,
                                    report.curve.back().plan.thresholds.geometric_px));
  return plot;
}

}  // namespace

std::string yaml_of(const TuneReport& report, const TunePoint& point) {
  std::string yaml = "regulator:\n  policy: " + report.policy +
                     "\n  geometric_px: " + formatted("%g", point.plan.thresholds.geometric_px) + "\n";
  const std::vector<std::size_t> moved = moved_layers(report, point);
  if (!moved.empty()) yaml += "layers:  # into the entries of these names\n";
  for (const std::size_t k : moved)
    yaml += "  - name: " + Json(report.layers[k]).dump() + "\n    preferences: {importance: {geometric: " +
            formatted("%g", point.plan.thresholds.weights[k]) + "}}  # " +
            formatted("%.3g px", point.plan.thresholds.geometric_px / point.plan.thresholds.weights[k]) +
            "\n";
  return yaml;
}

Plot tune_plot(const TuneReport& report) {
  if (!report.goal.is_of_pictures()) return time_plot_of(report);
  Plot plot{"quality against cost (" + report.sequence + "): " + report.goal.in_words(),
            {"modelled drawing time, of reference", "%", false},
            {report.goal.kind == GoalKind::Psnr ? "PSNR against reference" : "FLIP against reference",
             report.goal.kind == GoalKind::Psnr ? "dB" : "", report.goal.kind == GoalKind::Flip},
            {}};
  plot.series = {series_of_quality(report, "worst frame", true, false),
                 series_of_quality(report, "worst, partly drawn", false, false),
                 series_of_quality(report, "mean", true, true)};
  double least = 100;
  for (const TunePoint& point : report.curve) least = std::min(least, 100 * report.cost_share(point.plan));
  plot.series.push_back(goal_line(report, least, 100));
  if (report.per_layer) {
    const ShownQuality measured = measured_of(report, report.per_layer->point);
    const bool of_mean = report.goal.of_mean;
    PlotSeries own{of_mean ? "per layer, mean" : "per layer, worst", {}, SeriesStyle::Points, {}};
    own.points = {
        {100 * report.cost_share(report.per_layer->point.plan), of_mean ? measured.mean : measured.worst}};
    plot.series.push_back(own);
  }
  return plot;
}

std::string tune_csv(const TuneReport& report) {
  const char* unit = report.goal.kind == GoalKind::Psnr ? "psnr_db" : "flip";
  std::string csv = formatted(
      "setting,geometric_px,cost_ms,cost_share,worst_ms,mean_ms,worst_%s,mean_%s,frames_drawn,frames\n", unit,
      unit);
  const auto add = [&](const char* name, const TunePoint& point) {
    const ShownQuality measured = measured_of(report, point);
    csv += std::string(name) + "," + exact(point.plan.thresholds.geometric_px) + "," +
           exact(point.plan.cost_ms) + "," + exact(report.cost_share(point.plan)) + "," +
           exact(worst_of(point.plan.frame_ms)) + "," + exact(mean_of(point.plan.frame_ms)) + "," +
           exact(measured.worst) + "," + exact(measured.mean) + "," +
           std::to_string(point.quality.frames_drawn) + "," + std::to_string(report.frames()) + "\n";
  };
  for (const TunePoint& point : report.curve) add("grid", point);
  if (report.common) add("one for all", report.common->point);
  if (report.per_layer) add("per layer", report.per_layer->point);
  return csv;
}

std::string json_of(const TuneReport& report) {
  Json curve = Json::array();
  for (const TunePoint& point : report.curve) curve.push_back(json_of_point(report, point));
  const Json json{{"schema", "talisman.tune/1"},
                  {"sequence", report.sequence},
                  {"policy", report.policy},
                  {"display_px", {report.display_px.x, report.display_px.y}},
                  {"first_frame", report.range.first},
                  {"last_frame", report.range.last},
                  {"goal", report.goal.in_words()},
                  {"complete", !report.is_stopped},
                  {"frames_drawn", report.frames_drawn},
                  {"one_for_all", json_of_answer(report, report.common)},
                  {"per_layer", json_of_answer(report, report.per_layer)},
                  {"curve", curve}};
  return json.dump(1) + "\n";
}

void write_report(const TuneReport& report, const std::string& dir) {
  write_text_atomically(dir + "/tune.csv", tune_csv(report));
  write_text_atomically(dir + "/tune.json", json_of(report));
  write_plot(dir, "tune-curve", tune_plot(report), kLargePlot);
}

Page page_of(const TuneReport& report) {
  Page page{"The cheapest thresholds: " + report.sequence, {}, {}, "tune.html"};
  page.blocks = {Paragraph{measured_on(report.sequence, report.range, report.display_px) + ", policy " +
                           report.policy + ", goal " + report.goal.in_words()},
                 curve_table(report), Figure{"tune-curve.svg", tune_plot(report).title},
                 Paragraph{std::to_string(report.frames_drawn) + " frames drawn, as many as " +
                           fixed(report.full_renders(), 1) + " full renders"}};
  if (!report.common) return page;
  page.verdict = (report.common->holds ? "One threshold for all layers: " : "Not reached; nearest: ") +
                 formatted("%g px, ", report.common->point.plan.thresholds.geometric_px) +
                 answer_line(report, *report.common) + ".";
  page.blocks.push_back(Verbatim{yaml_of(report, report.common->point)});
  if (!report.per_layer) return page;
  page.blocks.push_back(Paragraph{"per layer: " + answer_line(report, *report.per_layer)});
  page.blocks.push_back(Verbatim{yaml_of(report, report.per_layer->point)});
  return page;
}

}  // namespace talisman::sequences
