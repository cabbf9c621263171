// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/plots.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/statistics.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {
namespace {

using Quantity = double (*)(const SettingResult&);

double flip_of(const SettingResult& r) { return r.quality.flip; }
double polygons_of(const SettingResult& r) { return double(r.polygons); }

std::vector<double> column(const RegulatorReport& report, Quantity quantity) {
  std::vector<double> values;
  for (const SettingResult& result : report.settings) values.push_back(quantity(result));
  return values;
}

/// The settings of one plot: where each one lies, in the plot's units.
struct Scatter {
  std::vector<double> x, y;
  int samples = 0;  ///< pictures that y is a mean of; 0: not of pictures
};

int pictures_of(const RegulatorReport& report) {
  return static_cast<int>(sampled_frames(report.frames).size());
}

PlotSeries series_of(const RegulatorReport& report, const Scatter& at, const std::string& name) {
  PlotSeries series{name, {}, SeriesStyle::LinePoints, {}};
  for (std::size_t k = 0; k < report.settings.size(); ++k) {
    if (report.settings[k].setting.series != name) continue;
    series.points.push_back({at.x[k], at.y[k]});
    // The thresholds of lookahead and oracle are those of the policy threshold, and lie close to it.
    const bool repeated = report.settings[k].setting.unit == "px" && name != "threshold";
    series.labels.push_back(repeated ? "" : report.settings[k].setting.knob());
    if (at.samples > 0) series.samples.push_back(at.samples);
    if (!report.runs.empty()) series.links.push_back({report.settings[k].setting.words(), report.runs[k]});
  }
  return series;
}

PlotSeries front_of(const Scatter& at) { return front_series(at.x, at.y, pareto_front(at.x, at.y)); }

/// The full price as a vertical line, since an error of 0 has no place on a logarithmic axis.
PlotSeries reference_line(const Scatter& at) {
  double lo = HUGE_VAL, hi = 0;
  for (const double y : at.y)
    if (y > 0) lo = std::min(lo, y), hi = std::max(hi, y);
  PlotSeries line{"reference: no error", {}, SeriesStyle::Line, {}};
  if (hi > 0) line.points = {{at.x[0], lo}, {at.x[0], hi}};
  return line;
}

/// The sixth series is the front, so that the oracle, the seventh, is black.
void add_series(Plot& plot, const RegulatorReport& report, const Scatter& at, const PlotSeries& sixth) {
  for (const std::string& name : {std::string("hold"), std::string("interpolate"), std::string("threshold"),
                                  "lookahead " + std::to_string(kComparedLookahead), std::string("budget")})
    plot.series.push_back(series_of(report, at, name));
  plot.series.push_back(sixth);
  plot.series.push_back(series_of(report, at, "oracle"));
  plot.series.push_back(reference_line(at));
  plot.series.push_back(series_of(report, at, "budget best"));
}

PlotAxis polygon_axis() { return {"polygons drawn, of reference", "%", true}; }

std::vector<double> polygon_shares(const RegulatorReport& report) {
  std::vector<double> shares = column(report, polygons_of);
  const double all = shares.front();
  for (double& share : shares) share = all > 0 ? 100 * share / all : NAN;
  return shares;
}

/// What is 0 but for rounding would stretch the axis over ten decades. Not computed stays not computed.
constexpr double kLeastFiducial = 1e-3;
double drawn_fiducial(double value) { return value < kLeastFiducial ? kLeastFiducial : value; }

}  // namespace

std::vector<bool> polygon_front(const RegulatorReport& report) {
  return pareto_front(column(report, polygons_of), column(report, flip_of));
}

Plot time_plot(const RegulatorReport& report) {
  Plot plot{"what accuracy costs in time: picture error against time per frame (" + report.sequence + ")",
            {"measured time per frame: plan, render, composite", "ms", true},
            {"FLIP against reference: less is better", "", true},
            {}};
  const Scatter at{column(report, [](const SettingResult& r) { return r.frame_ms(); }),
                   column(report, flip_of), pictures_of(report)};
  add_series(plot, report, at, front_of(at));
  return plot;
}

Plot polygon_plot(const RegulatorReport& report) {
  Plot plot{"picture error against polygons drawn (" + report.sequence + ")",
            polygon_axis(),
            {"FLIP against reference: less is better", "", true},
            {}};
  const Scatter at{polygon_shares(report), column(report, flip_of), pictures_of(report)};
  add_series(plot, report, at, front_of(at));
  return plot;
}

Plot bound_plot(const RegulatorReport& report) {
  Plot plot{
      "largest geometric error against renders (" + report.sequence + "): the oracle is the floor of renders",
      {"update rate, mean over layers", "%", true},
      {"largest geometric error displayed", "px", true},
      {}};
  const Scatter at{column(report, [](const SettingResult& r) { return 100 * r.mean_update_rate; }),
                   column(report, [](const SettingResult& r) { return r.max_geometric_px; }), 0};
  add_series(plot, report, at, front_of(at));
  return plot;
}

Plot popping_plot(const RegulatorReport& report) {
  Plot plot{"popping: step of the error where a sprite is drawn again (" + report.sequence + ")",
            polygon_axis(),
            {"popping, RMS: less is better", "code values", true},
            {}};
  const Scatter at{polygon_shares(report),
                   column(report, [](const SettingResult& r) { return r.popping.rms; }), pictures_of(report)};
  add_series(plot, report, at, front_of(at));
  return plot;
}

Plot lookahead_plot(const LookaheadCurve& curve) {
  Plot plot{"lookahead: renders against frames known ahead, bound " + fixed(curve.geometric_px, 2) + " px",
            {"N, frames known ahead (0 is drawn at 0.5)", "frames", true},
            {"update rate, mean over layers", "%", false},
            {}};
  const double last = curve.points.empty() ? 1 : std::max(curve.points.back().frames, 1);
  plot.series.push_back({"threshold",
                         {{0.5, 100 * curve.threshold_rate}, {last, 100 * curve.threshold_rate}},
                         SeriesStyle::Line,
                         {}});
  for (const LookaheadPoint& point : curve.points) {
    const std::string name = "lookahead, " + point.prediction;
    if (plot.series.back().name != name) plot.series.push_back({name, {}, SeriesStyle::LinePoints, {}});
    plot.series.back().points.push_back(
        {point.frames > 0 ? double(point.frames) : 0.5, 100 * point.mean_update_rate});
  }
  plot.series.push_back({"oracle: the floor of renders",
                         {{0.5, 100 * curve.oracle_rate}, {last, 100 * curve.oracle_rate}},
                         SeriesStyle::Line,
                         {}});
  return plot;
}

Plot calibration_plot(const RegulatorReport& report, std::size_t index) {
  const CalibrationSummary& summary = report.calibration[index];
  const CalibratedFiducial& fiducial = *summary.fiducial;
  Plot plot{std::string(fiducial.label) + " against image error: rank correlation " +
                (summary.error.defined ? fixed(summary.error.rho, 2) : "undefined") +
                ", n = " + std::to_string(summary.error.n),
            {std::string(fiducial.label) + ", at least " + fixed(kLeastFiducial, 3), fiducial.unit, true},
            {"error of the layer alone, RMS", "code values", true},
            {}};
  PlotSeries samples{"layer and frame", {}, SeriesStyle::Cloud, {}};
  for (const CalibrationSample& sample : report.samples)
    samples.points.push_back({drawn_fiducial(sample.fiducials[index]), sample.error});
  PlotSeries median{"median of an octave", {}, SeriesStyle::LinePoints, {}};
  PlotSeries lower{"quartiles", {}, SeriesStyle::Line, {}},
      upper{"upper quartile", {}, SeriesStyle::Line, {}};
  for (const CalibrationBin& bin : summary.bins) {
    median.points.push_back({bin.center, bin.median_error});
    median.labels.push_back(fixed(bin.median_error, 1));
    median.samples.push_back(bin.samples);
    lower.points.push_back({bin.center, bin.lower_error});
    upper.points.push_back({bin.center, bin.upper_error});
  }
  lower.name = "lower quartile";
  plot.series = {samples, median, lower, upper};
  return plot;
}

void write_regulator_plots(const RegulatorReport& report, const std::string& dir) {
  write_plot(dir, "regulator", time_plot(report), kLargePlot);
  write_plot(dir, "regulator-polygons", polygon_plot(report), kLargePlot);
  write_plot(dir, "regulator-bound", bound_plot(report), kLargePlot);
  write_plot(dir, "regulator-popping", popping_plot(report), kLargePlot);
  write_plot(dir, "lookahead", lookahead_plot(report.lookahead), kLargePlot);
  for (std::size_t index = 0; index < report.calibration.size(); ++index)
    write_plot(dir, std::string("calibration-") + report.calibration[index].fiducial->name,
               calibration_plot(report, index), kLargePlot);
}

}  // namespace talisman::sequences
