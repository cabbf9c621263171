// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/regulator/plots.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot_links.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {
namespace {

using Json = nlohmann::ordered_json;

constexpr NamedValue<SettingResult> kColumns[] = {
    {"mean_update_rate", [](const SettingResult& r) { return r.mean_update_rate; }},
    {"weighted_update_rate", [](const SettingResult& r) { return r.weighted_update_rate; }},
    {"renders", [](const SettingResult& r) { return double(r.renders); }},
    {"polygons", [](const SettingResult& r) { return double(r.polygons); }},
    {"pixels", [](const SettingResult& r) { return double(r.pixels); }},
    {"chunks", [](const SettingResult& r) { return double(r.chunks); }},
    {"modelled_ms", [](const SettingResult& r) { return r.modelled_ms; }},
    {"mean_geometric_px", [](const SettingResult& r) { return r.mean_geometric_px; }},
    {"max_geometric_px", [](const SettingResult& r) { return r.max_geometric_px; }},
    {"psnr_db", [](const SettingResult& r) { return r.quality.psnr_db; }},
    {"ssim", [](const SettingResult& r) { return r.quality.ssim; }},
    {"flip", [](const SettingResult& r) { return r.quality.flip; }},
    {"popping_rms", [](const SettingResult& r) { return r.popping.rms; }},
    {"popping_p95", [](const SettingResult& r) { return r.popping.p95; }},
    {"popping_elsewhere_rms", [](const SettingResult& r) { return r.popping.elsewhere_rms; }},
    {"popping_share", [](const SettingResult& r) { return r.popping.stepping_share; }},
    {"wall_plan_mean_ms", [](const SettingResult& r) { return r.plan.mean; }},
    {"wall_plan_median_ms", [](const SettingResult& r) { return r.plan.median; }},
    {"wall_render_mean_ms", [](const SettingResult& r) { return r.render.mean; }},
    {"wall_render_median_ms", [](const SettingResult& r) { return r.render.median; }},
    {"wall_composite_mean_ms", [](const SettingResult& r) { return r.composite.mean; }},
    {"wall_composite_median_ms", [](const SettingResult& r) { return r.composite.median; }},
    {"wall_frame_mean_ms", [](const SettingResult& r) { return r.frame_ms(); }},
};

Json settings_json(const RegulatorReport& report) {
  Json all = Json::array();
  for (const SettingResult& result : report.settings) {
    Json json = {{"policy", result.setting.series},
                 {"knob", result.setting.unit.empty() ? Json(nullptr) : Json(result.setting.value)},
                 {"knob_unit", result.setting.unit}};
    put(json, kColumns, result);
    all.push_back(json);
  }
  return all;
}

Json lookahead_json(const LookaheadCurve& curve) {
  Json points = Json::array();
  for (const LookaheadPoint& p : curve.points)
    points.push_back({{"prediction", p.prediction},
                      {"lookahead_frames", p.frames},
                      {"renders", p.renders},
                      {"mean_update_rate", p.mean_update_rate},
                      {"max_geometric_px", p.max_geometric_px},
                      {"wall_plan_us_per_layer_and_frame", p.plan_us}});
  return {{"geometric_px", curve.geometric_px},
          {"display_px", {curve.display_px.x, curve.display_px.y}},
          {"threshold_renders", curve.threshold_renders},
          {"oracle_renders", curve.oracle_renders},
          {"points", points}};
}

Json rank_json(const RankCorrelation& rank) {
  return {{"spearman_rho", rank.defined ? Json(rank.rho) : Json(nullptr)}, {"n", rank.n}};
}

Json calibration_json(const RegulatorReport& report) {
  Json all = Json::array();
  for (const CalibrationSummary& c : report.calibration) {
    Json bins = Json::array();
    for (const CalibrationBin& bin : c.bins)
      bins.push_back({{"center", bin.center},
                      {"samples", bin.samples},
                      {"median_error", bin.median_error},
                      {"lower_quartile_error", bin.lower_error},
                      {"upper_quartile_error", bin.upper_error},
                      {"median_psnr_db", number_or_null(bin.psnr_db())},
                      {"median_apparent_shift_px", bin.median_shift_px}});
    all.push_back({{"fiducial", c.fiducial->name},
                   {"unit", c.fiducial->unit},
                   {"error", rank_json(c.error)},
                   {"apparent_shift", rank_json(c.shift)},
                   {"median_rho_of_layers", c.layers > 0 ? Json(c.median_rho_of_layers) : Json(nullptr)},
                   {"layers", c.layers},
                   {"bins", bins}});
  }
  return all;
}

// --- Tables

PageTable cost_table(const RegulatorReport& report) {
  PageTable table{{"policy", "knob", "rate %", "weighted %", "polygons %", "pixels %", "chunks %", "plan ms",
                   "render ms", "composite ms", "median ms", "modelled ms"},
                  {},
                  2};
  const SettingResult& reference = report.settings.front();
  for (const SettingResult& r : report.settings)
    table.rows.push_back(
        {r.setting.series, r.setting.knob(), fixed(100 * r.mean_update_rate, 1),
         fixed(100 * r.weighted_update_rate, 1), percent_of(double(r.polygons), double(reference.polygons)),
         percent_of(double(r.pixels), double(reference.pixels)),
         percent_of(double(r.chunks), double(reference.chunks)), fixed(r.plan.mean, 2),
         fixed(r.render.mean, 1), fixed(r.composite.mean, 1),
         fixed(r.plan.median + r.render.median + r.composite.median, 1), fixed(r.modelled_ms, 2)});
  table.links = report.runs;
  return table;
}

PageTable error_table(const RegulatorReport& report) {
  PageTable table{{"policy", "knob", "mean px", "max px", "PSNR dB", "SSIM", "FLIP", "popping", "p95",
                   "elsewhere", "steps %", "front"},
                  {},
                  2};
  const std::vector<bool> front = polygon_front(report);
  for (std::size_t k = 0; k < report.settings.size(); ++k) {
    const SettingResult& r = report.settings[k];
    table.rows.push_back({r.setting.series, r.setting.knob(), fixed(r.mean_geometric_px, 3),
                          fixed(r.max_geometric_px, 2), fixed(r.quality.psnr_db, 2), fixed(r.quality.ssim, 4),
                          fixed(r.quality.flip, 4), fixed(r.popping.rms, 2), fixed(r.popping.p95, 0),
                          fixed(r.popping.elsewhere_rms, 2), fixed(100 * r.popping.stepping_share, 1),
                          front[k] ? "*" : ""});
  }
  return table;
}

PageTable lookahead_table(const LookaheadCurve& curve) {
  PageTable table{
      {"motion", "N", "renders", "of threshold %", "over oracle %", "rate %", "max px", "plan us"}, {}, 1};
  const auto row = [&](const std::string& name, const std::string& n, std::int64_t renders, double rate,
                       const std::string& max_px, const std::string& plan_us) {
    table.rows.push_back({name, n, std::to_string(renders),
                          percent_of(double(renders), double(curve.threshold_renders)),
                          percent_of(double(renders - curve.oracle_renders), double(curve.oracle_renders)),
                          fixed(100 * rate, 1), max_px, plan_us});
  };
  row("threshold", "-", curve.threshold_renders, curve.threshold_rate, "-", "-");
  for (const LookaheadPoint& p : curve.points)
    row(p.prediction, std::to_string(p.frames), p.renders, p.mean_update_rate, fixed(p.max_geometric_px, 2),
        fixed(p.plan_us, 1));
  row("oracle", "-", curve.oracle_renders, curve.oracle_rate, "-", "-");
  return table;
}

std::string rho_text(const RankCorrelation& rank) { return rank.defined ? fixed(rank.rho, 3) : "-"; }

PageTable calibration_table(const std::vector<CalibrationSummary>& calibration) {
  PageTable table{{"fiducial", "n", "rho", "rho in a layer", "layers", "rho of shift"}, {}, 1};
  for (const CalibrationSummary& c : calibration)
    table.rows.push_back({c.fiducial->name, std::to_string(c.computed), rho_text(c.error),
                          c.layers > 0 ? fixed(c.median_rho_of_layers, 3) : "-", std::to_string(c.layers),
                          rho_text(c.shift)});
  return table;
}

/// "1 px of the geometric fiducial: median error …" for each fiducial that has samples around 1.
std::string in_words(const std::vector<CalibrationSummary>& calibration) {
  std::string words;
  for (const CalibrationSummary& c : calibration)
    for (const CalibrationBin& bin : c.bins)
      if (bin.center == 1)
        words += (words.empty() ? "1 " : "\n1 ") + std::string(c.fiducial->unit) + " of " + c.fiducial->name +
                 " buys a median error of " + fixed(bin.median_error, 2) + " code values (" +
                 fixed(bin.psnr_db(), 1) + " dB), quartiles " + fixed(bin.lower_error, 2) + " and " +
                 fixed(bin.upper_error, 2) + ", n = " + std::to_string(bin.samples);
  return words;
}

std::string size_text(layers::ivec2 px) { return std::to_string(px.x) + "x" + std::to_string(px.y); }

/// Under the bound that is compared and nearest to the sequence's own.
std::string verdict_on(const RegulatorReport& report) {
  const auto distance = [&](double px) {
    return std::fabs(std::log(px / std::max(report.given.regulator.thresholds.geometric_px, 1e-3)));
  };
  double bound_px = compared_thresholds().front();
  for (const double px : compared_thresholds())
    if (distance(px) < distance(bound_px)) bound_px = px;
  const auto all = double(report.settings.front().polygons);
  std::string text;
  for (const SettingResult& r : report.settings)
    if (r.setting.unit == "px" && r.setting.value == bound_px)
      text += (text.empty() ? formatted("Under a bound of %g px ", bound_px) : ", ") + r.setting.series +
              " draws " + percent_of(double(r.polygons), all) + " % of the polygons of reference (FLIP " +
              fixed(r.quality.flip, 4) + ")";
  return text.empty() ? text : text + ".";
}

std::vector<Block> cost_and_error(const RegulatorReport& report) {
  return {
      Heading{2, "What it costs"},
      Paragraph{"% of reference; ms per frame, mean, measured on this machine; median of the sum"},
      cost_table(report),
      Figure{"regulator.svg", "Picture error against measured time of a frame.",
             links_of(time_plot(report), kLargePlot)},
      Heading{2, "How far from the truth"},
      Paragraph{
          "geometric error displayed; picture against reference; popping: step of the error, code values, "
          "where sprites are drawn again (RMS, 95th percentile), and elsewhere; * least FLIP for its "
          "polygons"},
      error_table(report),
      Figure{"regulator-polygons.svg", "Picture error against polygons drawn: without the noise of a clock.",
             links_of(polygon_plot(report), kLargePlot)},
      Figure{"regulator-bound.svg",
             "Largest geometric error against renders: the oracle is the floor of renders.",
             links_of(bound_plot(report), kLargePlot)},
      Figure{"regulator-popping.svg", "Popping against polygons drawn.",
             links_of(popping_plot(report), kLargePlot)}};
}

std::vector<Block> fiducials_and_pictures(const RegulatorReport& report) {
  std::vector<Block> blocks = {
      Heading{2, "What fiducials say of the picture"},
      Paragraph{"against image error of each layer alone, Spearman's rho (1: rise together)"},
      calibration_table(report.calibration)};
  if (const std::string words = in_words(report.calibration); !words.empty())
    blocks.push_back(Paragraph{words});
  for (const CalibrationSummary& c : report.calibration) {
    const std::string name = c.fiducial->name;
    blocks.push_back(
        Figure{"calibration-" + name + ".svg", "Image error of a layer against its " + name + " fiducial."});
  }
  return blocks;
}

}  // namespace

std::string settings_csv(const RegulatorReport& report) {
  std::string csv = "policy,knob,knob_unit,pareto_polygons" + csv_names(kColumns) + "\n";
  const std::vector<bool> front = polygon_front(report);
  for (std::size_t k = 0; k < report.settings.size(); ++k) {
    const RegulatorSetting& setting = report.settings[k].setting;
    csv += setting.series + "," + (setting.unit.empty() ? "" : exact(setting.value)) + "," + setting.unit +
           (front[k] ? ",1" : ",0") + csv_cells(kColumns, report.settings[k]) + "\n";
  }
  return csv;
}

std::string samples_csv(const RegulatorReport& report) {
  std::string csv = "frame,layer,age_frames";
  for (const CalibratedFiducial& fiducial : calibrated_fiducials())
    csv += std::string(",") + fiducial.name + (std::string(fiducial.unit) == "%" ? "_percent" : "_px");
  csv += ",error,psnr_db,apparent_shift_px,pixels\n";
  for (const CalibrationSample& s : report.samples) {
    csv +=
        std::to_string(s.frame) + "," + quoted(report.layers[s.layer]) + "," + std::to_string(s.age_frames);
    for (const double value : s.fiducials) csv += "," + exact(value);
    csv += "," + exact(s.error) + "," + exact(s.error > 0 ? 20 * std::log10(255 / s.error) : HUGE_VAL) + "," +
           exact(s.apparent_shift_px) + "," + std::to_string(s.pixels) + "\n";
  }
  return csv;
}

std::string json_of(const RegulatorReport& report) {
  const Json json = {{"schema", "talisman.regulator/1"},
                     {"sequence", report.sequence},
                     {"warp", report.warp},
                     {"display_px", {report.display_px.x, report.display_px.y}},
                     {"settings_given", json_of(report.given)},
                     {"first_frame", report.frames.first},
                     {"last_frame", report.frames.last},
                     {"quality_every", report.frames.every},
                     {"frames_compared", sampled_frames(report.frames).size()},
                     {"settings", settings_json(report)},
                     {"lookahead", lookahead_json(report.lookahead)},
                     {"calibration", calibration_json(report)}};
  return json.dump(1) + "\n";
}

void write_report(const RegulatorReport& report, const std::string& dir) {
  write_regulator_plots(report, dir);
  write_text_atomically(dir + "/regulator.csv", settings_csv(report));  // all numbers of the plots, and more
  write_text_atomically(dir + "/calibration.csv", samples_csv(report));
  write_text_atomically(dir + "/regulator.json", json_of(report));
}

Page page_of(const RegulatorReport& report) {
  Page page{"What accuracy costs in time: " + report.sequence, {}, verdict_on(report), "regulator.html"};
  add(page, {Paragraph{measured_on(report.sequence, report.frames, report.display_px) + "; all planned, " +
                       std::to_string(sampled_frames(report.frames).size()) +
                       " of them drawn and compared (one in " + std::to_string(report.frames.every) +
                       "), warp " + report.warp}});
  if (!report.runs.empty())
    add(page,
        {Paragraph{"each point of the plots and each row of the first table opens its run, planned again, "
                   "with every decision and its reason: " +
                   std::to_string(report.runs.size()) + " reports, " + fixed(report.runs_mb, 1) +
                   " MB, made in " + fixed(report.runs_s, 1) + " s"}});
  add(page, cost_and_error(report));
  add(page,
      {Heading{2, "Lookahead"},
       Paragraph{"at " + fixed(report.lookahead.geometric_px, 2) + " px, " +
                 size_text(report.lookahead.display_px) + " px display, plan only"},
       lookahead_table(report.lookahead), Figure{"lookahead.svg", "Renders against frames known ahead."}});
  add(page, fiducials_and_pictures(report));
  return page;
}

}  // namespace talisman::sequences
