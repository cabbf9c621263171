// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "sequences/experiments/latency/displayed.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

std::string quoted_cell(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

std::string latency_cells(const ShownLatency& row) {
  return exact(row.render_ms) + "," + exact(row.warp_ms) + "," + std::string(name(row.predict));
}

std::string csv_of(const DisplayedExperiment& experiment) {
  std::string csv =
      "render_ms,warp_ms,predict,turn_p50_deg,turn_p95_deg,turn_max_deg,turn_p50_px,turn_p95_px,turn_max_px,"
      "overshoot_p50_deg,overshoot_p95_deg,overshoot_max_deg,way,polygons_per_frame,reused,age_p50,age_p95,"
      "age_max,"
      "px_p50,px_p95,px_max,judder_px,flip,uncovered\n";
  for (const ShownLatency& row : experiment.rows)
    for (const ShownWay& way : row.ways) {
      csv += latency_cells(row);
      for (const Spread& spread : {row.pose.turn_deg, row.pose.turn_px, row.pose.overshoot_deg})
        for (const double value : {spread.p50, spread.p95, spread.max}) csv += "," + exact(value);
      csv += "," + quoted_cell(way.name);
      for (const double value :
           {way.polygons_per_frame, way.reused, way.age_frames.p50, way.age_frames.p95, way.age_frames.max,
            way.px.p50, way.px.p95, way.px.max, way.judder_px, way.flip, way.uncovered})
        csv += "," + exact(value);
      csv += "\n";
    }
  return csv;
}

std::string layers_csv_of(const DisplayedExperiment& experiment) {
  std::string csv =
      "render_ms,warp_ms,predict,way,layer,px_p50,px_p95,px_max,judder_px,pixels,flip,uncovered\n";
  for (const ShownLatency& row : experiment.rows)
    for (const ShownWay& way : row.ways)
      for (const ShownLayer& layer : way.layers) {
        csv += latency_cells(row) + "," + quoted_cell(way.name) + "," + quoted_cell(layer.name);
        for (const double value : {layer.px.p50, layer.px.p95, layer.px.max, layer.judder_px,
                                   static_cast<double>(layer.pixels), layer.flip, layer.uncovered})
          csv += "," + exact(value);
        csv += "\n";
      }
  return csv;
}

/// FLIP over polygons: a series for each way, a point for each latency and prediction.
Plot flip_plot(const DisplayedExperiment& experiment) {
  Plot plot{"shown late: " + experiment.sequence,
            {"polygons per frame", "", false, true, {}},
            {"FLIP, mean", "", false, true, {}},
            {}};
  for (const ShownLatency& row : experiment.rows)
    for (const ShownWay& way : row.ways) {
      auto series = std::find_if(plot.series.begin(), plot.series.end(),
                                 [&](const PlotSeries& one) { return one.name == way.name; });
      if (series == plot.series.end())
        series = plot.series.insert(series, PlotSeries{way.name, {}, SeriesStyle::Points});
      series->points.push_back({way.polygons_per_frame, way.flip});
    }
  return plot;
}

const ShownLayer* layer_of(const ShownWay& way, const std::string& name) {
  const auto at = std::find_if(way.layers.begin(), way.layers.end(),
                               [&](const ShownLayer& layer) { return layer.name == name; });
  return at == way.layers.end() ? nullptr : &*at;
}

std::string share_text(double share) { return fixed(100 * share, 2) + " %"; }

PageTable table_of(const DisplayedExperiment& experiment) {
  PageTable table{{"RENDER ms", "predict", "shown by", "polygons", "reused", "age p95", "px p50", "p95",
                   "max", "judder px", "FLIP", "uncovered"},
                  {},
                  3};
  for (const ShownLatency& row : experiment.rows)
    for (const ShownWay& way : row.ways)
      table.rows.push_back({fixed(row.render_ms, 0), std::string(name(row.predict)), way.name,
                            fixed(way.polygons_per_frame, 0), share_text(way.reused),
                            fixed(way.age_frames.p95, 0), fixed(way.px.p50, 2), fixed(way.px.p95, 2),
                            fixed(way.px.max, 1), fixed(way.judder_px, 2), fixed(way.flip, 4),
                            share_text(way.uncovered)});
  return table;
}

PageTable pose_table(const DisplayedExperiment& experiment) {
  PageTable table{
      {"RENDER ms", "predict", "turn p50 °", "p95", "max", "px p50", "p95", "max", "overshoot p95 °", "max"},
      {},
      2};
  for (const ShownLatency& row : experiment.rows) {
    std::vector<std::string> cells = {fixed(row.render_ms, 0), std::string(name(row.predict))};
    for (const Spread& spread : {row.pose.turn_deg, row.pose.turn_px})
      cells.insert(cells.end(), {fixed(spread.p50, 3), fixed(spread.p95, 3), fixed(spread.max, 3)});
    cells.insert(cells.end(), {fixed(row.pose.overshoot_deg.p95, 3), fixed(row.pose.overshoot_deg.max, 3)});
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// What is set beside the layers: the way of whole frames that is best by FLIP, at these polygons.
const ShownWay* best_whole(const ShownLatency& row, bool same_polygons) {
  const ShownWay* best = nullptr;
  for (const ShownWay& way : row.ways) {
    const bool is_same = way.name.find("same polygons") != std::string::npos;
    if (way.is_whole && is_same == same_polygons && (best == nullptr || way.flip < best->flip)) best = &way;
  }
  return best;
}

/// Layers that whole frames show better, or worse, than `layers`: by FLIP where they are seen.
std::string layers_by_winner(const ShownWay& layers, const ShownWay& whole, bool layers_win) {
  std::string names;
  for (const ShownLayer& layer : layers.layers) {
    const ShownLayer* other = layer_of(whole, layer.name);
    if (other == nullptr || layer.pixels == 0 || (layer.flip < other->flip) != layers_win) continue;
    names +=
        (names.empty() ? "" : ", ") + layer.name + " " + fixed(layer.flip, 3) + ":" + fixed(other->flip, 3);
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::vector<std::string> verdict_of(const DisplayedExperiment& experiment) {
  std::vector<std::string> lines;
  for (const ShownLatency& row : experiment.rows) {
    const ShownWay& layers = row.ways.front();
    for (const bool same_polygons : {false, true}) {
      const ShownWay* whole = best_whole(row, same_polygons);
      if (whole == nullptr) continue;
      lines.push_back(fixed(row.render_ms, 0) + " ms, " + std::string(name(row.predict)) + ": layers FLIP " +
                      fixed(layers.flip, 4) + " with " + fixed(layers.polygons_per_frame, 0) + " polygons, " +
                      whole->name + " " + fixed(whole->flip, 4) + " with " +
                      fixed(whole->polygons_per_frame, 0) + ": " +
                      (layers.flip < whole->flip ? "layers win" : "layers lose") + "\n  layers win at   " +
                      layers_by_winner(layers, *whole, true) + "\n  layers lose at  " +
                      layers_by_winner(layers, *whole, false));
    }
  }
  return lines;
}

void write_report(const DisplayedExperiment& experiment, const std::string& dir) {
  write_text_atomically(dir + "/displayed.csv", csv_of(experiment));
  write_text_atomically(dir + "/displayed-layers.csv", layers_csv_of(experiment));
  write_plot(dir, "displayed-plot", flip_plot(experiment));
}

Page page_of(const DisplayedExperiment& experiment) {
  Page page{"Late displays: " + experiment.sequence, {}, "", "displayed.html"};
  page.blocks = {Paragraph{measured_on(experiment.sequence, experiment.frames, experiment.display_px)},
                 Heading{2, "The pose that decisions know, against the true one"},
                 pose_table(experiment),
                 Heading{2, "What is shown, against direct at the true pose"},
                 Paragraph{formatted("Pictures of %d frames, points of all.", experiment.drawn)},
                 table_of(experiment),
                 Heading{2, "Layers beside the best whole frames (FLIP, where each layer is seen)"}};
  std::string verdict;
  for (const std::string& line : verdict_of(experiment)) verdict += line + "\n";
  add(page, {Verbatim{verdict}, Figure{"displayed-plot.svg", "FLIP over the polygons of a frame."}});
  return page;
}

}  // namespace talisman::sequences
