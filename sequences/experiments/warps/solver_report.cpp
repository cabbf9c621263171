// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/solver_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/statistics.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {
namespace {

using warp::Family;

/// Index of the count that the plots and the long table show: the points of a box and of its faces.
constexpr int kShown = 2;
/// What gains less than this share gains nothing.
constexpr double kLeastGain = 1e-4;

int inputs_for(const Solver& solver, int inputs) { return solver.slow ? std::min(inputs, 16) : inputs; }

void time_in_rounds(MeasuredSolvers& rungs, const Workbench& bench, std::size_t n) {
  constexpr int kRounds = 3;
  std::vector<TimedSolver> timed;
  for (const MeasuredSolver& rung : rungs) timed.emplace_back(rung.solver, bench, rung.inputs);
  for (int round = 0; round < kRounds; ++round)
    for (TimedSolver& solver : timed) solver.run_round();
  for (std::size_t k = 0; k < rungs.size(); ++k) rungs[k].times[n] = timed[k].result();
}

/// Of all rungs, at the count that is shown.
struct ScatteredRungs {
  std::vector<double> time_us, error_px;
};

ScatteredRungs scattered(const MeasuredSolvers& rungs) {
  ScatteredRungs at;
  for (const MeasuredSolver& rung : rungs) {
    at.time_us.push_back(rung.times[kShown].median_us);
    at.error_px.push_back(rung.accuracies[kShown].mean_max_px);
  }
  return at;
}

std::vector<bool> front_of(const MeasuredSolvers& rungs) {
  std::vector<bool> front;
  for (const MeasuredSolver& rung : rungs) front.push_back(rung.on_front);
  return front;
}

void mark_front(MeasuredSolvers& rungs) {
  const ScatteredRungs at = scattered(rungs);
  const std::vector<bool> front = pareto_front(at.time_us, at.error_px, kLeastGain);
  for (std::size_t k = 0; k < rungs.size(); ++k) rungs[k].on_front = front[k];
}

// --- Numbers as text

std::string text(const char* pattern, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

/// Three significant digits without an exponent, for times.
std::string micro(double us) { return fixed(us, us < 1 ? 3 : us < 10 ? 2 : us < 100 ? 1 : 0); }

std::string short_percent(double share) {
  return std::fabs(share) < 5e-8 ? "0" : text(std::fabs(share) >= 1e4 ? "%.1e" : "%.4g", 100 * share);
}

std::string power_of_ten(double value) {
  return std::isfinite(value) && value > 0 ? text("%.0e", value) : "none";
}

/// Empty where there is nothing to keep, or no size at which it is kept.
std::string stability_csv(const MeasuredSolver& rung) {
  const FitStability& s = rung.stability;
  if (!rung.solver.exact) return ",,";
  return text(",%.0e", s.largest_offset_px) +
         (std::isfinite(s.smallest_sprite_px) ? text(",%.0e", s.smallest_sprite_px) : ",");
}

std::string csv_of(const MeasuredSolvers& rungs) {
  std::string csv =
      "solver,family,points,inputs,median_us,p99_us,mean_max_px,mean_excess,worst_excess,mean_rms_excess,"
      "unfinished,uncertified,largest_offset_px,smallest_sprite_px,pareto\n";
  for (const MeasuredSolver& rung : rungs)
    for (std::size_t n = 0; n < kPointCounts.size(); ++n) {
      const FitAccuracy& a = rung.accuracies[n];
      csv += "\"" + rung.solver.name + "\"," + std::string(warp::name(rung.solver.family)) + "," +
             std::to_string(kPointCounts[n]) + "," + std::to_string(rung.inputs) + "," +
             fixed(rung.times[n].median_us, 4) + "," + fixed(rung.times[n].p99_us, 4);
      for (const double value : {a.mean_max_px, a.mean_excess, a.worst_excess, a.mean_rms_excess})
        csv += text(",%.9g", value);
      csv += "," + std::to_string(a.unfinished) + "," +
             (rung.solver.promised_gap >= 0 ? std::to_string(a.uncertified) : "") + stability_csv(rung) +
             (rung.on_front && n == kShown ? ",1\n" : ",0\n");
    }
  return csv;
}

PageTable accuracy_table(const MeasuredSolvers& rungs) {
  PageTable table{{"solver", "family", "median us", "p99 us", "max px", "excess %", "worst %", "rms excess %",
                   "unfinished", "uncertified", "offset px", "sprite px", "front"},
                  {},
                  2};
  for (const MeasuredSolver& rung : rungs) {
    const FitAccuracy& a = rung.accuracies[kShown];
    const std::string of = "/" + std::to_string(rung.inputs);
    table.rows.push_back(
        {rung.solver.name, std::string(warp::name(rung.solver.family)), micro(rung.times[kShown].median_us),
         micro(rung.times[kShown].p99_us), text("%.4g", a.mean_max_px), short_percent(a.mean_excess),
         short_percent(a.worst_excess), short_percent(a.mean_rms_excess), std::to_string(a.unfinished) + of,
         rung.solver.promised_gap >= 0 ? std::to_string(a.uncertified) + of : "-",
         rung.solver.exact ? power_of_ten(rung.stability.largest_offset_px) : "-",
         rung.solver.exact ? power_of_ten(rung.stability.smallest_sprite_px) : "-",
         rung.on_front ? "*" : ""});
  }
  return table;
}

PageTable time_table(const MeasuredSolvers& rungs) {
  PageTable table{{"solver"}, {}, 1};
  for (const int n : kPointCounts) table.header.push_back("n = " + std::to_string(n));
  for (const MeasuredSolver& rung : rungs) {
    std::vector<std::string> row{rung.solver.name};
    for (const FitTime& time : rung.times) row.push_back(micro(time.median_us) + " / " + micro(time.p99_us));
    table.rows.push_back(row);
  }
  return table;
}

// --- Plots

PlotAxis time_axis() { return {"median time per fit, 14 points", "µs", true}; }

/// Time against pixels, one series per family, the front as a line.
Plot overview_plot(const MeasuredSolvers& rungs) {
  Plot plot{"what accuracy costs: largest error against time",
            time_axis(),
            {"largest error, mean over the workload", "px", false},
            {}};
  for (const Family family :
       {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine, Family::Perspective}) {
    PlotSeries series{std::string(warp::name(family)), {}, SeriesStyle::Points, {}};
    for (const MeasuredSolver& rung : rungs) {
      if (rung.solver.family != family) continue;
      series.points.push_back({rung.times[kShown].median_us, rung.accuracies[kShown].mean_max_px});
      series.labels.push_back(rung.on_front ? rung.solver.name : "");
    }
    plot.series.push_back(series);
  }
  const ScatteredRungs at = scattered(rungs);
  plot.series.push_back(front_series(at.time_us, at.error_px, front_of(rungs)));
  return plot;
}

/// Inside one family: time against the excess over the certified optimum.
Plot family_plot(const MeasuredSolvers& rungs, Family family) {
  constexpr double kFloor = 1e-8;  // per cent; what is exact to the last digits is drawn here
  const std::string name(warp::name(family));
  Plot plot{name + ": excess over the certified optimum against time",
            time_axis(),
            {"excess of the largest error, mean", "%", true},
            {}};
  PlotSeries mean{"mean", {}, SeriesStyle::Points, {}}, worst{"worst", {}, SeriesStyle::Points, {}};
  for (const MeasuredSolver& rung : rungs) {
    if (rung.solver.family != family) continue;
    const FitAccuracy& a = rung.accuracies[kShown];
    mean.points.push_back({rung.times[kShown].median_us, std::fmax(100 * a.mean_excess, kFloor)});
    mean.labels.push_back(rung.solver.name);
    worst.points.push_back({rung.times[kShown].median_us, std::fmax(100 * a.worst_excess, kFloor)});
  }
  plot.series = {mean, worst};
  return plot;
}

/// From one end of the front to the other.
std::string verdict_on(const MeasuredSolvers& rungs) {
  std::vector<const MeasuredSolver*> front;
  for (const MeasuredSolver& rung : rungs)
    if (rung.on_front) front.push_back(&rung);
  if (front.empty()) return {};
  const auto us = [](const MeasuredSolver* rung) { return rung->times[kShown].median_us; };
  std::sort(front.begin(), front.end(), [&](auto* a, auto* b) { return us(a) < us(b); });
  const auto words = [&](const MeasuredSolver* rung) {
    return rung->solver.name + text(" (%.4g px", rung->accuracies[kShown].mean_max_px) + " in " +
           micro(us(rung)) + " us)";
  };
  return std::to_string(front.size()) + " of " + std::to_string(rungs.size()) + " lie on the front, from " +
         words(front.front()) + " to " + words(front.back()) + ".";
}

}  // namespace

MeasuredSolvers measure_solvers(int inputs, ProgressKind progress_kind) {
  MeasuredSolvers rungs;
  for (const Solver& solver : solver_ladder())
    rungs.push_back({solver, {}, {}, {}, inputs_for(solver, inputs), false});
  Progress progress(progress_kind, "solvers", static_cast<int>(rungs.size() * (kPointCounts.size() + 1)));
  for (std::size_t n = 0; n < kPointCounts.size(); ++n) {
    const Workbench bench = make_workbench(kPointCounts[n], inputs);
    time_in_rounds(rungs, bench, n);
    for (MeasuredSolver& rung : rungs) {
      rung.accuracies[n] = accuracy_of(rung.solver, bench, rung.inputs);
      progress.advance();
    }
  }
  for (MeasuredSolver& rung : rungs) {
    if (rung.solver.exact) rung.stability = stability_of(rung.solver);
    progress.advance();
  }
  mark_front(rungs);
  return rungs;
}

void write_report(const MeasuredSolvers& rungs, const std::string& dir) {
  write_plot(dir, "solvers", overview_plot(rungs), kLargePlot);
  write_text_atomically(dir + "/solvers.csv", csv_of(rungs));  // has all numbers of the plot, and more
  write_plot(dir, "solvers-affine", family_plot(rungs, Family::Affine), kLargePlot);
  write_plot(dir, "solvers-perspective", family_plot(rungs, Family::Perspective), kLargePlot);
}

Page page_of(const MeasuredSolvers& rungs) {
  return {
      "What a warp costs: " + std::to_string(rungs.size()) + " solvers",
      {Heading{2, "Accuracy"},
       Paragraph{
           "14 points; max px: mean of the largest error; excess: over the certified optimum of the family"},
       accuracy_table(rungs), Figure{"solvers.svg", "Largest error against time, all families."},
       Figure{"solvers-affine.svg", "Affine: excess over the certified optimum against time."},
       Figure{"solvers-perspective.svg", "Perspective: the same."}, Heading{2, "Time"},
       Paragraph{"microseconds per fit, median / 99th percentile"}, time_table(rungs)},
      verdict_on(rungs),
      "solvers.html"};
}

}  // namespace talisman::sequences
