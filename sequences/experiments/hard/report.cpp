// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/hard/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sequences/experiments/large_plot.h"
#include "sequences/experiments/named_values.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {
namespace {

/// What is exact to the last bit, and what breaks a rule of nothing, are drawn here.
constexpr double kDrawnLeast = 1e-6, kDrawnMost = 100;

std::string short_number(double value) { return std::isfinite(value) ? number_text("%.2g", value) : "none"; }

std::string rule_text(const HardRule& rule) {
  return (rule.most == 0 ? "0 " : "<= " + short_number(rule.most) + " ") + std::string(rule.unit);
}

PageTable table_of_stage(const HardReport& report, HardStage stage) {
  PageTable table{{"case", "what is special", "rule", "oracle", "worst error", "status"}, {}, 4};
  for (const MeasuredHardCase& m : report.cases)
    if (m.hard.stage == stage)
      table.rows.push_back({std::string(m.hard.name), std::string(m.hard.special), rule_text(m.hard.rule),
                            std::string(m.hard.rule.oracle), short_number(m.outcome.error),
                            std::string(name(m.status))});
  return table;
}

int count_status(const HardReport& report, HardStatus status) {
  return int(std::count_if(report.cases.begin(), report.cases.end(),
                           [status](const MeasuredHardCase& m) { return m.status == status; }));
}

double drawn_share(const MeasuredHardCase& m) {
  const double most = m.hard.rule.most, error = m.outcome.error;
  const double share = most > 0 ? error / most : error > 0 ? HUGE_VAL : 0;
  return std::isnan(share) ? kDrawnMost : std::clamp(share, kDrawnLeast, kDrawnMost);
}

/// Neighbours share a colour, for there are more stages than colours that can be told apart.
constexpr std::pair<const char*, std::array<HardStage, 2>> kDrawnTogether[] = {
    {"warps", {HardStage::Warps, HardStage::Warps}},
    {"clipping, polyhedra", {HardStage::Clipping, HardStage::Polyhedra}},
    {"shading, shadow", {HardStage::Shading, HardStage::Shadow}},
    {"order, regulator", {HardStage::Order, HardStage::Regulator}},
    {"compositor", {HardStage::Compositor, HardStage::Compositor}},
    {"scale", {HardStage::Scale, HardStage::Scale}}};

Plot plot_of_cases(const HardReport& report) {
  Plot plot{"hard cases: error as a share of the rule (exact ones at 1e-6)",
            {"how extreme: ratio of lengths, counts, brightness", "", true},
            {"error over rule", "", true},
            {}};
  for (const auto& [title, stages] : kDrawnTogether) {
    PlotSeries series{title, {}, SeriesStyle::Points};
    for (const MeasuredHardCase& m : report.cases)
      if (m.hard.stage == stages[0] || m.hard.stage == stages[1])
        series.points.push_back({m.hard.extreme, drawn_share(m)});
    plot.series.push_back(series);
  }
  return plot;
}

Plot plot_of_widths(const std::string& title, const std::vector<WidthCurve>& curves) {
  Plot plot{title, {"distance from the origin over size", "", true}, {"largest error", "px", true}, {}};
  for (const WidthCurve& curve : curves) {
    PlotSeries series{curve.name, {}};
    for (const WidthPoint& p : curve.points) series.points.push_back({p.ratio, p.error_px});
    plot.series.push_back(series);
  }
  return plot;
}

std::string csv_of_cases(const HardReport& report) {
  std::string csv = "stage,case,special,extreme,rule,unit,oracle,to_be_refused,error,status\n";
  for (const MeasuredHardCase& m : report.cases) {
    const HardCase& hard = m.hard;
    csv += std::string(name(hard.stage)) + "," + quoted(std::string(hard.name)) + "," +
           quoted(std::string(hard.special)) + "," + exact(hard.extreme) + "," + exact(hard.rule.most) + "," +
           quoted(std::string(hard.rule.unit)) + "," + quoted(std::string(hard.rule.oracle)) + "," +
           (hard.rule.refused ? "1," : "0,") + exact(m.outcome.error) + "," +
           quoted(std::string(name(m.status))) + "\n";
  }
  return csv;
}

std::string broken_lines(const HardReport& report) {
  std::string lines;
  for (const MeasuredHardCase& m : report.cases) {
    if (m.status != HardStatus::Broken) continue;
    lines += std::string(lines.empty() ? "" : "\n") + "broken: " + std::string(name(m.hard.stage)) + ", " +
             std::string(m.hard.name) + ": " + short_number(m.outcome.error) + " " +
             std::string(m.hard.rule.unit);
    if (m.outcome.refused != m.hard.rule.refused) lines += m.outcome.refused ? ", refused" : ", not refused";
    lines += ", rule: " + rule_text(m.hard.rule) + (m.hard.rule.refused ? " and a refusal" : "");
  }
  return lines;
}

std::string verdict_on(const HardReport& report) {
  double least = 1, most = 1;
  for (const MeasuredHardCase& m : report.cases)
    least = std::min(least, m.hard.extreme), most = std::max(most, m.hard.extreme);
  return std::to_string(report.cases.size()) + " cases, extremes " + short_number(least) + " ... " +
         short_number(most) + ": " + std::to_string(count_status(report, HardStatus::Holds)) + " hold, " +
         std::to_string(count_status(report, HardStatus::Refused)) + " are refused as they should, " +
         std::to_string(count_status(report, HardStatus::Broken)) + " are broken";
}

}  // namespace

HardReport measure_hard_report(ProgressKind progress_kind) {
  HardReport report;
  const std::vector<HardCase> cases = all_hard_cases();
  Progress progress(progress_kind, "hard cases", int(cases.size()));
  for (const HardCase& hard : cases) {
    report.cases.push_back(measure_hard_case(hard));
    progress.advance();
  }
  report.widths = measure_number_widths();
  return report;
}

int broken_cases(const HardReport& report) { return count_status(report, HardStatus::Broken); }

void write_report(const HardReport& report, const std::string& dir) {
  write_text_atomically(dir + "/hard.csv", csv_of_cases(report));
  write_plot(dir, "hard-cases", plot_of_cases(report), kLargePlot);
  write_plot(dir, "hard-fit",
             plot_of_widths("affine fit of a sprite of 200 px, exact data", report.widths.fits), kLargePlot);
  write_plot(dir, "hard-projection",
             plot_of_widths("a box of 2 m, 8 m before a camera of 1024 px", report.widths.projections),
             kLargePlot);
}

Page page_of(const HardReport& report) {
  Page page{"Hard cases of every stage", {}, verdict_on(report), "hard.html"};
  for (const HardStage stage : kAllHardStages) {
    page.blocks.push_back(Heading{2, std::string(name(stage))});
    page.blocks.push_back(table_of_stage(report, stage));
  }
  if (const std::string broken = broken_lines(report); !broken.empty())
    page.blocks.push_back(Paragraph{broken});
  page.blocks.push_back(
      Figure{"hard-cases.svg", "The error of each case as a share of what its rule allows."});
  page.blocks.push_back(
      Figure{"hard-fit.svg", "An affine fit in single and in double precision, ever farther away."});
  page.blocks.push_back(Figure{"hard-projection.svg", "The same for the projection of a box."});
  return page;
}

}  // namespace talisman::sequences
