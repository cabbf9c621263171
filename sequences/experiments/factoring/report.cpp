// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/report.h"

#include <nlohmann/json.hpp>

#include "sequences/experiments/factoring/pictures.h"
#include "sequences/experiments/named_values.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/statistics.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {
namespace {

using Json = nlohmann::ordered_json;

constexpr NamedValue<PictureLoss> kLossColumns[] = {
    {"rms_code_values",
     [](const PictureLoss& l) { return rms_code_values(summarize(l.frames).mean.psnr_db); }},
    {"max_code_values",
     [](const PictureLoss& l) { return double(summarize(l.frames).worst.max_difference); }},
    {"psnr_db", [](const PictureLoss& l) { return summarize(l.frames).mean.psnr_db; }},
    {"ssim", [](const PictureLoss& l) { return summarize(l.frames).mean.ssim; }},
    {"flip", [](const PictureLoss& l) { return summarize(l.frames).mean.flip; }},
    {"changed_pixels", [](const PictureLoss& l) { return summarize(l.frames).mean.changed_pixels; }},
};

constexpr NamedValue<FactoredLayer> kLayerColumns[] = {
    {"shade_layers", [](const FactoredLayer& l) { return double(l.shade_layers); }},
    {"frames_shown", [](const FactoredLayer& l) { return double(l.frames_shown); }},
    {"predicted_rms", [](const FactoredLayer& l) { return l.check.predicted.rms(); }},
    {"predicted_max", [](const FactoredLayer& l) { return l.check.predicted.largest; }},
    {"by_formula_rms", [](const FactoredLayer& l) { return l.check.by_formula.rms(); }},
    {"by_formula_max", [](const FactoredLayer& l) { return l.check.by_formula.largest; }},
    {"measured_rms", [](const FactoredLayer& l) { return l.check.measured.rms(); }},
    {"measured_max", [](const FactoredLayer& l) { return l.check.measured.largest; }},
    {"unexplained_rms", [](const FactoredLayer& l) { return l.check.unexplained.rms(); }},
    {"unexplained_max", [](const FactoredLayer& l) { return l.check.unexplained.largest; }},
    {"elsewhere_rms", [](const FactoredLayer& l) { return l.check.elsewhere.rms(); }},
    {"elsewhere_max", [](const FactoredLayer& l) { return l.check.elsewhere.largest; }},
    {"elsewhere_share",
     [](const FactoredLayer& l) {
       return l.check.measured.count > 0 ? double(l.check.elsewhere.count) / double(l.check.measured.count)
                                         : 0;
     }},
    {"rounding_bound_max", [](const FactoredLayer& l) { return l.check.largest_bound; }},
    {"largest_share_of_bound", [](const FactoredLayer& l) { return l.check.largest_share_of_bound; }},
    {"values_beyond_bound", [](const FactoredLayer& l) { return double(l.check.beyond_bound); }},
};

constexpr NamedValue<SettingResult> kCostColumns[] = {
    {"mean_update_rate", [](const SettingResult& r) { return r.mean_update_rate; }},
    {"renders", [](const SettingResult& r) { return double(r.renders); }},
    {"polygons", [](const SettingResult& r) { return double(r.polygons); }},
    {"pixels", [](const SettingResult& r) { return double(r.pixels); }},
    {"chunks", [](const SettingResult& r) { return double(r.chunks); }},
    {"modelled_ms", [](const SettingResult& r) { return r.modelled_ms; }},
    {"wall_plan_ms", [](const SettingResult& r) { return r.plan.mean; }},
    {"wall_render_ms", [](const SettingResult& r) { return r.render.mean; }},
    {"wall_composite_ms", [](const SettingResult& r) { return r.composite.mean; }},
    {"wall_frame_ms", [](const SettingResult& r) { return r.frame_ms(); }},
};

template <typename Row, std::size_t N>
std::string csv_line(const std::string& name, const Row& row, const NamedValue<Row> (&columns)[N]) {
  return quoted(name) + csv_cells(columns, row) + "\n";
}

template <typename Row, std::size_t N>
Json json_row(const char* key, const std::string& name, const Row& row, const NamedValue<Row> (&columns)[N]) {
  Json json = {{key, name}};
  put(json, columns, row);
  return json;
}

FactoredLayer whole_frame(const FactoringReport& report) {
  FactoredLayer frame{"frame", 0, static_cast<int>(report.result.sampled.size()), report.result.frame};
  for (const FactoredLayer& layer : report.result.layers) frame.shade_layers += layer.shade_layers;
  return frame;
}

std::vector<FactoredLayer> layers_and_frame(const FactoringReport& report) {
  std::vector<FactoredLayer> rows = report.result.layers;
  rows.push_back(whole_frame(report));
  return rows;
}

// --- Tables

std::string percent_with(double share, int digits) { return fixed(100 * share, digits); }

std::string rms_and_max(const ErrorSum& sum) {
  return percent_with(sum.rms(), 4) + " / " + percent_with(sum.largest, 2);
}

PageTable prediction_table(const FactoringReport& report) {
  PageTable table{{"factored alone", "shades", "by formula", "predicted", "measured", "unexplained",
                   "elsewhere", "bound", "of it %", "beyond"},
                  {},
                  1};
  for (const FactoredLayer& layer : layers_and_frame(report)) {
    const PredictionCheck& c = layer.check;
    table.rows.push_back({layer.name, std::to_string(layer.shade_layers), rms_and_max(c.by_formula),
                          rms_and_max(c.predicted), rms_and_max(c.measured), rms_and_max(c.unexplained),
                          rms_and_max(c.elsewhere), percent_with(c.largest_bound, 2),
                          percent_with(c.largest_share_of_bound, 1), std::to_string(c.beyond_bound)});
  }
  return table;
}

PageTable loss_table(const FactoringReport& report) {
  PageTable table{{"picture", "RMS", "max", "PSNR dB", "SSIM", "FLIP", "pixels changed %"}, {}, 1};
  for (const PictureLoss& loss : report.result.losses) {
    const DiffSummary s = summarize(loss.frames);
    table.rows.push_back({name(loss.picture), fixed(rms_code_values(s.mean.psnr_db), 3),
                          std::to_string(s.worst.max_difference), fixed(s.mean.psnr_db, 2),
                          fixed(s.mean.ssim, 5), fixed(s.mean.flip, 5),
                          percent_with(s.mean.changed_pixels, 2)});
  }
  return table;
}

PageTable cost_table(const FactoringReport& report) {
  PageTable table{{"sequence", "rate %", "renders", "polygons", "pixels", "chunks", "plan ms", "render ms",
                   "composite ms", "modelled ms"},
                  {},
                  1};
  const auto row = [&](const char* name, const SettingResult& r) {
    table.rows.push_back({name, percent_with(r.mean_update_rate, 1), std::to_string(r.renders),
                          std::to_string(r.polygons), std::to_string(r.pixels), std::to_string(r.chunks),
                          fixed(r.plan.mean, 2), fixed(r.render.mean, 1), fixed(r.composite.mean, 2),
                          fixed(r.modelled_ms, 2)});
  };
  row("factored", report.result.factored);
  row("unfactored", report.result.unfactored);
  return table;
}

/// What it draws of the unfactored polygons, pixels, …
std::string verdict_on(const FactoringReport& report) {
  const SettingResult &a = report.result.factored, &b = report.result.unfactored;
  const auto share = [](double part, double whole) {
    return (whole > 0 ? percent_with(part / whole, 1) : "-") + " %";
  };
  return "Factored, of unfactored: polygons " + share(double(a.polygons), double(b.polygons)) + ", pixels " +
         share(double(a.pixels), double(b.pixels)) + ", chunks " + share(double(a.chunks), double(b.chunks)) +
         ", modelled " + share(a.modelled_ms, b.modelled_ms) + ", measured " +
         share(a.frame_ms(), b.frame_ms()) + ".";
}

}  // namespace

std::string pictures_csv(const FactoringReport& report) {
  std::string csv = "picture" + csv_names(kLossColumns) + "\n";
  for (const PictureLoss& loss : report.result.losses)
    csv += csv_line(name(loss.picture), loss, kLossColumns);
  return csv;
}

std::string layers_csv(const FactoringReport& report) {
  std::string csv = "layer" + csv_names(kLayerColumns) + "\n";
  for (const FactoredLayer& layer : layers_and_frame(report))
    csv += csv_line(layer.name, layer, kLayerColumns);
  return csv;
}

std::string costs_csv(const FactoringReport& report) {
  return "sequence" + csv_names(kCostColumns) + "\n" +
         csv_line("factored", report.result.factored, kCostColumns) +
         csv_line("unfactored", report.result.unfactored, kCostColumns);
}

std::string json_of(const FactoringReport& report) {
  Json layers = Json::array(), pictures = Json::array();
  for (const FactoredLayer& layer : report.result.layers)
    layers.push_back(json_row("layer", layer.name, layer, kLayerColumns));
  for (const PictureLoss& loss : report.result.losses)
    pictures.push_back(json_row("picture", name(loss.picture), loss, kLossColumns));
  const Json json = {
      {"schema", "talisman.factoring/1"},
      {"sequence", report.sequence},
      {"policy", report.policy},
      {"warp", report.warp},
      {"display_px", {report.display_px.x, report.display_px.y}},
      {"settings_given", json_of(report.given)},
      {"first_frame", report.frames.first},
      {"last_frame", report.frames.last},
      {"quality_every", report.frames.every},
      {"frames_compared", report.result.sampled},
      {"error_unit", "linear light, 1: white"},
      {"layers", layers},
      {"frame", json_row("layer", "frame", whole_frame(report), kLayerColumns)},
      {"pictures", pictures},
      {"unfactored_blends_as_materials_say", report.result.blends_over_time},
      {"costs", Json::array({json_row("sequence", "factored", report.result.factored, kCostColumns),
                             json_row("sequence", "unfactored", report.result.unfactored, kCostColumns)})},
      {"pictured_frame", report.result.worst.frame}};
  return json.dump(1) + "\n";
}

void write_report(const FactoringReport& report, const std::string& dir) {
  write_factoring_pictures(report, dir);
  write_text_atomically(dir + "/factoring.csv", pictures_csv(report));
  write_text_atomically(dir + "/factoring-layers.csv", layers_csv(report));
  write_text_atomically(dir + "/factoring-costs.csv", costs_csv(report));
  write_text_atomically(dir + "/factoring.json", json_of(report));
}

Page page_of(const FactoringReport& report) {
  Page page{"Shading in sprites of its own: " + report.sequence, {}, verdict_on(report), "factoring.html"};
  page.blocks = {
      Paragraph{measured_on(report.sequence, report.frames, report.display_px) + ", policy " + report.policy +
                ", warp " + report.warp + "; " + std::to_string(report.result.sampled.size()) +
                " frames drawn and compared (one in " + std::to_string(report.frames.every) + ")"},
      Heading{2, "Over alone: what is predicted, and what is measured"},
      Paragraph{
          "error of the frame, RMS / largest, % of white in linear light; predicted: by the formula and what "
          "it does "
          "not know;\nunexplained: measured - predicted; elsewhere: measured where nothing is predicted; "
          "bound: of "
          "rounding (8-bit sprites, 16-bit compositor);\nof it: the largest share of its own bound that an "
          "unexplained error reaches; beyond: how many are larger"},
      prediction_table(report),
      Figure{"factoring.png", "The frame with the largest error, both ways, and maps of the error."},
      Figure{"factoring-prediction.svg", "Measured error against predicted error."},
      Heading{2, "What is lost"},
      Paragraph{"against the unfactored truth: code values of the sRGB frame; each + adds to the line above"},
      loss_table(report)};
  if (report.result.blends_over_time)
    page.blocks.push_back(
        Paragraph{"textures are blended over time, which the unfactored sequence cannot: its truth "
                  "has the blends of the materials"});
  const std::vector<Block> costs = {
      Figure{"factoring-losses.svg", "The loss of every picture, frame by frame."},
      Heading{2, "What factoring saves"},
      Paragraph{"the sequence under its own policy; ms per frame, mean, measured on this machine"},
      cost_table(report)};
  page.blocks.insert(page.blocks.end(), costs.begin(), costs.end());
  return page;
}

}  // namespace talisman::sequences
