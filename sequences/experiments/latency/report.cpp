// SPDX-License-Identifier: Apache-2.0

#include "sequences/experiments/latency/latency_curve.h"
#include "sequences/experiments/published.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/number_text.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

using regulator::Prediction;

std::string csv_of(const LatencyCurve& curve) {
  std::string csv = "render_ms,warp_ms,predict,turn_p50_deg,turn_p95_deg,turn_max_deg";
  for (const LastWarp warp : kAllLastWarps)
    for (const char* share : {"p50", "p95", "max"})
      csv += "," + std::string(name(warp)) + "_" + share + "_px";
  csv += "\n";
  for (const LatencyResult& r : curve.results) {
    csv += exact(r.render_ms) + "," + exact(std::min(curve.warp_ms, r.render_ms)) + "," +
           std::string(name(r.predictor));
    for (const double value : {r.turn_deg.p50, r.turn_deg.p95, r.turn_deg.max}) csv += "," + exact(value);
    for (const Spread& error : r.error_px)
      for (const double value : {error.p50, error.p95, error.max}) csv += "," + exact(value);
    csv += "\n";
  }
  return csv;
}

/// A curve for each predictor without a last warp, and for each last warp of the held pose.
Plot plot_of(const LatencyCurve& curve) {
  Plot plot{"points off by latency: " + curve.sequence,
            {"RENDER", "ms", false, true, {}},
            {"error, 95th percentile", "px", false, true, {}},
            {}};
  const auto add = [&](Prediction predictor, LastWarp warp) {
    PlotSeries series{
        std::string(name(predictor)) + (warp == LastWarp::None ? "" : ", " + std::string(name(warp))), {}};
    for (const LatencyResult& r : curve.results)
      if (r.predictor == predictor)
        series.points.push_back({r.render_ms, r.error_px[static_cast<std::size_t>(warp)].p95});
    plot.series.push_back(std::move(series));
  };
  for (const Prediction predictor : {Prediction::Held, Prediction::Linear, Prediction::Kalman})
    add(predictor, LastWarp::None);
  for (const LastWarp warp : {LastWarp::Homography, LastWarp::Layers, LastWarp::Depth})
    add(Prediction::Held, warp);
  return plot;
}

PageTable latency_table(const LatencyCurve& curve) {
  PageTable table{{"RENDER ms", "predict", "turn p50 °", "p95", "max", "px none p95", "max", "homography p95",
                   "max", "layers p95", "max", "depth p95", "max"},
                  {},
                  2};
  for (const LatencyResult& r : curve.results) {
    std::vector<std::string> row = {fixed(r.render_ms, 0), std::string(name(r.predictor)),
                                    fixed(r.turn_deg.p50, 3), fixed(r.turn_deg.p95, 3),
                                    fixed(r.turn_deg.max, 3)};
    for (const Spread& error : r.error_px) row.insert(row.end(), {fixed(error.p95, 3), fixed(error.max, 2)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Of a held pose at half of the longest latency.
std::string verdict_on(const LatencyCurve& curve) {
  constexpr double kShown_ms = 50;
  for (const LatencyResult& r : curve.results) {
    if (r.render_ms != kShown_ms || r.predictor != Prediction::Held) continue;
    std::string text =
        "A pose that is held for " + fixed(kShown_ms, 0) + " ms leaves 95 % of the points off by less than";
    for (std::size_t k = 0; k < kAllLastWarps.size(); ++k)
      text += (k > 0 ? ", " : " ") + fixed(r.error_px[k].p95, 2) + " px" +
              (k == 0 ? "" : " with last warp '" + std::string(name(kAllLastWarps[k])) + "'");
    return text + ".";
  }
  return {};
}

}  // namespace

void write_report(const LatencyCurve& curve, const std::string& dir) {
  write_text_atomically(dir + "/latency.csv", csv_of(curve));
  write_plot(dir, "latency-plot", plot_of(curve));
}

Page page_of(const LatencyCurve& curve) {
  Page page{"Old poses: " + curve.sequence, {}, verdict_on(curve), "latency.html"};
  page.blocks = {Paragraph{measured_on(curve.sequence, curve.frames, curve.display_px) +
                           formatted(", last warp at %s ms, %lld points; geometry alone",
                                     fixed(curve.warp_ms, 0).c_str(), static_cast<long long>(curve.points))},
                 latency_table(curve),
                 Figure{"latency-plot.svg", "How far points are off, over the age of the pose."}};
  return page;
}

}  // namespace talisman::sequences
