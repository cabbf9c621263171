// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "sequences/commands/accuracy_factoring.h"
#include "sequences/commands/accuracy_renderer.h"
#include "sequences/commands/experiment_options.h"
#include "sequences/experiments/warps/solver_measure.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {
namespace {

using warp::Family;

constexpr std::array kPointCounts = {4, 8, 14, 26, 64};
/// The count that the plots and the long table show: the points of a box and of its faces.
constexpr int kShown = 2;

/// One rung with everything that was measured.
struct Rung {
  Solver solver;
  std::array<FitTime, kPointCounts.size()> times;
  std::array<FitAccuracy, kPointCounts.size()> accuracies;
  FitStability stability;
  int inputs = 0;
  bool on_front = false;  ///< nothing else is as quick and as accurate
};

int inputs_for(const Solver& solver, int inputs) { return solver.slow ? std::min(inputs, 16) : inputs; }

void time_in_rounds(std::vector<Rung>& rungs, const Workbench& bench, std::size_t n) {
  constexpr int kRounds = 3;
  std::vector<TimedSolver> timed;
  for (const Rung& rung : rungs) timed.emplace_back(rung.solver, bench, rung.inputs);
  for (int round = 0; round < kRounds; ++round)
    for (TimedSolver& solver : timed) solver.run_round();
  for (std::size_t k = 0; k < rungs.size(); ++k) rungs[k].times[n] = timed[k].result();
}

std::vector<Rung> measure(const AccuracyOptions& options) {
  std::vector<Rung> rungs;
  for (const Solver& solver : solver_ladder())
    rungs.push_back({solver, {}, {}, {}, inputs_for(solver, options.inputs), false});
  Progress progress(progress_kind_from(options.progress), "solvers",
                    static_cast<int>(rungs.size() * (kPointCounts.size() + 1)));
  for (std::size_t n = 0; n < kPointCounts.size(); ++n) {
    const Workbench bench = make_workbench(kPointCounts[n], options.inputs);
    time_in_rounds(rungs, bench, n);
    for (Rung& rung : rungs) {
      rung.accuracies[n] = accuracy_of(rung.solver, bench, rung.inputs);
      progress.advance();
    }
  }
  for (Rung& rung : rungs) {
    if (rung.solver.exact) rung.stability = stability_of(rung.solver);
    progress.advance();
  }
  return rungs;
}

/// Walks from the quickest to the slowest; what gains less than a part in 10,000 gains nothing.
void mark_front(std::vector<Rung>& rungs) {
  std::vector<Rung*> by_time;
  for (Rung& rung : rungs) by_time.push_back(&rung);
  std::sort(by_time.begin(), by_time.end(), [](const Rung* a, const Rung* b) {
    return a->times[kShown].median_us < b->times[kShown].median_us;
  });
  double best = HUGE_VAL;
  for (Rung* rung : by_time) {
    const double error = rung->accuracies[kShown].mean_max_px;
    rung->on_front = error < best * (1 - 1e-4);
    if (rung->on_front) best = error;
  }
}

// --- Numbers as text

std::string text(const char* pattern, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

/// Three significant digits without an exponent, for times.
std::string micro(double us) { return fixed(us, us < 1 ? 3 : us < 10 ? 2 : us < 100 ? 1 : 0); }

std::string percent(double share) {
  return std::fabs(share) < 5e-8 ? "0" : text(std::fabs(share) >= 1e4 ? "%.1e" : "%.4g", 100 * share);
}

std::string power_of_ten(double value) {
  return std::isfinite(value) && value > 0 ? text("%.0e", value) : "none";
}

/// Empty where there is nothing to keep, or no size at which it is kept.
std::string stability_csv(const Rung& rung) {
  const FitStability& s = rung.stability;
  if (!rung.solver.exact) return ",,";
  return text(",%.0e", s.largest_offset_px) +
         (std::isfinite(s.smallest_sprite_px) ? text(",%.0e", s.smallest_sprite_px) : ",");
}

std::string csv_of(const std::vector<Rung>& rungs) {
  std::string csv =
      "solver,family,points,inputs,median_us,p99_us,mean_max_px,mean_excess,worst_excess,mean_rms_excess,"
      "unfinished,uncertified,largest_offset_px,smallest_sprite_px,pareto\n";
  for (const Rung& rung : rungs)
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

Table accuracy_table(const std::vector<Rung>& rungs) {
  Table table{{"solver", "family", "median us", "p99 us", "max px", "excess %", "worst %", "rms excess %",
               "unfinished", "uncertified", "offset px", "sprite px", "front"},
              {},
              2};
  for (const Rung& rung : rungs) {
    const FitAccuracy& a = rung.accuracies[kShown];
    const std::string of = "/" + std::to_string(rung.inputs);
    table.rows.push_back({rung.solver.name, std::string(warp::name(rung.solver.family)),
                          micro(rung.times[kShown].median_us), micro(rung.times[kShown].p99_us),
                          text("%.4g", a.mean_max_px), percent(a.mean_excess), percent(a.worst_excess),
                          percent(a.mean_rms_excess), std::to_string(a.unfinished) + of,
                          rung.solver.promised_gap >= 0 ? std::to_string(a.uncertified) + of : "-",
                          rung.solver.exact ? power_of_ten(rung.stability.largest_offset_px) : "-",
                          rung.solver.exact ? power_of_ten(rung.stability.smallest_sprite_px) : "-",
                          rung.on_front ? "*" : ""});
  }
  return table;
}

Table time_table(const std::vector<Rung>& rungs) {
  Table table{{"solver"}, {}, 1};
  for (const int n : kPointCounts) table.header.push_back("n = " + std::to_string(n));
  for (const Rung& rung : rungs) {
    std::vector<std::string> row{rung.solver.name};
    for (const FitTime& time : rung.times) row.push_back(micro(time.median_us) + " / " + micro(time.p99_us));
    table.rows.push_back(row);
  }
  return table;
}

// --- Plots

PlotAxis time_axis() { return {"median time per fit, 14 points", "µs", true}; }

/// Time against pixels, one series per family, the front as a line.
Plot overview_plot(const std::vector<Rung>& rungs) {
  Plot plot{"what accuracy costs: largest error against time",
            time_axis(),
            {"largest error, mean over the workload", "px", false},
            {}};
  for (const Family family :
       {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine, Family::Perspective}) {
    PlotSeries series{std::string(warp::name(family)), {}, SeriesStyle::Points, {}};
    for (const Rung& rung : rungs) {
      if (rung.solver.family != family) continue;
      series.points.push_back({rung.times[kShown].median_us, rung.accuracies[kShown].mean_max_px});
      series.labels.push_back(rung.on_front ? rung.solver.name : "");
    }
    plot.series.push_back(series);
  }
  PlotSeries front{"Pareto front", {}, SeriesStyle::Steps, {}};
  for (const Rung& rung : rungs)
    if (rung.on_front)
      front.points.push_back({rung.times[kShown].median_us, rung.accuracies[kShown].mean_max_px});
  std::sort(front.points.begin(), front.points.end(),
            [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  plot.series.push_back(front);
  return plot;
}

/// Inside one family: time against the excess over the certified optimum.
Plot family_plot(const std::vector<Rung>& rungs, Family family) {
  constexpr double kFloor = 1e-8;  // per cent; what is exact to the last digits is drawn here
  const std::string name(warp::name(family));
  Plot plot{name + ": excess over the certified optimum against time",
            time_axis(),
            {"excess of the largest error, mean", "%", true},
            {}};
  PlotSeries mean{"mean", {}, SeriesStyle::Points, {}}, worst{"worst", {}, SeriesStyle::Points, {}};
  for (const Rung& rung : rungs) {
    if (rung.solver.family != family) continue;
    const FitAccuracy& a = rung.accuracies[kShown];
    mean.points.push_back({rung.times[kShown].median_us, std::fmax(100 * a.mean_excess, kFloor)});
    mean.labels.push_back(rung.solver.name);
    worst.points.push_back({rung.times[kShown].median_us, std::fmax(100 * a.worst_excess, kFloor)});
  }
  plot.series = {mean, worst};
  return plot;
}

void write_results(const std::vector<Rung>& rungs, const std::string& dir) {
  PlotFiles files;
  files.width_px = 1000;
  files.height_px = 640;
  write_plot(dir, "solvers", overview_plot(rungs), files);
  write_text_atomically(dir + "/solvers.csv", csv_of(rungs));  // has all numbers of the plot, and more
  write_plot(dir, "solvers-affine", family_plot(rungs, Family::Affine), files);
  write_plot(dir, "solvers-perspective", family_plot(rungs, Family::Perspective), files);
}

}  // namespace

int run_accuracy(const AccuracyOptions& options, std::ostream& out) {
  const bool regulator = !options.regulator.sequence.empty(), renderer = !options.renderer.empty(),
             factoring = !options.factoring.empty();
  const int experiments = options.solvers + regulator + renderer + factoring;
  if (experiments != 1)
    throw InputError(
        "accuracy: " + std::string(experiments == 0 ? "nothing to measure" : "more than one experiment") +
        ", rule: one of --solvers, --regulator SEQUENCE, --renderer SEQUENCE, --factoring SEQUENCE");
  RegulatorCommandOptions asked = options.regulator;
  asked.progress = options.progress;
  if (regulator) return run_regulator_accuracy(asked, options.out, out);
  if (renderer) {
    asked.sequence = options.renderer;
    return run_renderer_accuracy(asked, options.out, out);
  }
  if (factoring) {
    asked.sequence = options.factoring;
    return run_factoring_accuracy(asked, options.out, out);
  }
  if (options.inputs < 1 || options.inputs > 100000)
    throw InputError("--inputs " + std::to_string(options.inputs) + ", rule: 1 … 100000");
  create_folder(options.out);
  std::vector<Rung> rungs = measure(options);
  mark_front(rungs);
  write_results(rungs, options.out);
  out << "14 points; max px: mean of the largest error; excess: over the certified optimum of the family\n"
      << plain_text(accuracy_table(rungs)) << "\nmicroseconds per fit, median / 99th percentile\n"
      << plain_text(time_table(rungs)) << "\nresults in " << options.out << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
