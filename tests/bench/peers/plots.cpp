// SPDX-License-Identifier: Apache-2.0
// Draws the curves of tests/bench/run:  bench_plots DIR < plots.json  writes DIR/NAME.svg and NAME.csv.
//
//   [{"name": "…", "title": "…", "x": {"label": "…", "unit": "…", "logarithmic": true}, "y": {…},
//     "series": [{"name": "…", "points": [[x, y], …]}, …]}, …]
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

#include "sequences/pictures/plot.h"

namespace talisman::bench {
namespace {

sequences::PlotAxis axis_from(const nlohmann::json& json) {
  sequences::PlotAxis axis;
  axis.label = json.at("label");
  axis.unit = json.value("unit", "");
  axis.logarithmic = json.value("logarithmic", false);
  axis.from_zero = !axis.logarithmic;
  axis.names = json.value("names", std::vector<std::string>());
  return axis;
}

sequences::Plot plot_from(const nlohmann::json& json) {
  sequences::Plot plot;
  plot.title = json.at("title");
  plot.x = axis_from(json.at("x"));
  plot.y = axis_from(json.at("y"));
  for (const nlohmann::json& curve : json.at("series")) {
    sequences::PlotSeries series;
    series.name = curve.at("name");
    if (!plot.x.names.empty()) series.style = sequences::SeriesStyle::Bars;
    for (const nlohmann::json& point : curve.at("points"))
      series.points.push_back({point.at(0), point.at(1)});
    plot.series.push_back(series);
  }
  return plot;
}

}  // namespace
}  // namespace talisman::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: bench_plots DIR < plots.json\n");
    return 2;
  }
  try {
    for (const nlohmann::json& json : nlohmann::json::parse(std::cin))
      talisman::sequences::write_plot(argv[1], json.at("name"), talisman::bench::plot_from(json));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: bench_plots: %s\n", e.what());
    return 1;
  }
}
