// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/figure_22.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "layers/check.h"
#include "sequences/experiments/reproduction/moving_average.h"
#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr double kSameCostShare = 0.02;

using FrameNumber = std::function<double(const FrameLine&)>;

double rendered_polygons(const FrameLine& line) { return static_cast<double>(line.polygons.rendered); }
double rendered_pixels(const FrameLine& line) { return static_cast<double>(line.pixels.rendered); }

ResourceUse use_measured(PaperBench& bench, const std::string& resource, const FrameNumber& number,
                         double speed) {
  const BarnyardPlans plans = barnyard_plans(bench, speed);
  std::vector<std::vector<double>> thresholds;
  for (const PlannedRun* run : plans.thresholds) thresholds.push_back(by_frame(*run, number));
  return resource_use(resource, by_frame(*plans.held, number), by_frame(*plans.interpolated, number),
                      thresholds);
}

/// What is warped is drawn beyond the display's edge, what is held is not: beside triple framing that is warped, too?
std::string against_interpolated(PaperBench& bench, const FrameNumber& number) {
  const BarnyardPlans plans = barnyard_plans(bench, 1);
  const std::vector<double> interpolated = by_frame(*plans.interpolated, number);
  const double whole = mean_of(interpolated);
  std::string text = "of interpolated triple framing in the mean";
  for (std::size_t k = 0; k < plans.thresholds.size(); ++k)
    text += (k > 0 ? ", " : " ") + fixed(mean_of(by_frame(*plans.thresholds[k], number)) / whole, 2) +
            formatted(" at %g px", barnyard_thresholds()[k]);
  return text;
}

/// Slower, the same scene moves less from frame to frame: is that all that it takes?
std::string use_at_other_speeds(PaperBench& bench, const std::string& resource, const FrameNumber& number,
                                Finding (*rule)(const ResourceUse&)) {
  std::string text;
  for (const double speed : {0.5, 0.25, 0.125}) {
    const Finding finding = rule(use_measured(bench, resource, number, speed));
    text += (text.empty() ? "at " : "; at ") + formatted("%g", speed) + " of the speed " +
            (finding.same ? "yes: " : "no: ") + finding.ours;
    if (finding.same) break;
  }
  return text + "; " + against_interpolated(bench, number);
}

/// Which layer costs more when it is warped between its beats?
std::string dearer_layer(PaperBench& bench) {
  const BarnyardPlans plans = barnyard_plans(bench, 1);
  const Summary &held = plans.held->summary, &interpolated = plans.interpolated->summary;
  const LayerSummary* dearest = nullptr;
  double most_ms = 0;
  for (std::size_t k = 0; k < std::min(held.layers.size(), interpolated.layers.size()); ++k) {
    const double more_ms = interpolated.layers[k].render_ms - held.layers[k].render_ms;
    if (!dearest || more_ms > most_ms) dearest = &interpolated.layers[k], most_ms = more_ms;
  }
  if (!dearest) return "there are no layers";
  return "most of it is '" + dearest->name + "': " + fixed(100 * interpolated.share_of_cost(*dearest), 0) +
         " % of the drawing time when interpolated, with sprites of up to " +
         formatted("%dx%d px", dearest->sprite_px.x, dearest->sprite_px.y) +
         ": what is warped needs to be drawn beyond the display's edge, what is held does not";
}

Claim use_claim(const std::string& id, const std::string& paper, const std::string& rule,
                const std::string& resource, const FrameNumber& number, Finding (*test)(const ResourceUse&)) {
  Claim claim{id, paper, rule,
              [=](PaperBench& bench) { return test(use_measured(bench, resource, number, 1)); },
              [=](PaperBench& bench) { return use_at_other_speeds(bench, resource, number, test); }};
  claim.sequence = barnyard_sequence().name;
  claim.must = barnyard_sequence().is_papers_own;
  return claim;
}

Plot use_plot(const ResourceUse& use, const std::string& sequence) {
  Plot plot{use.resource + " rendered (" + sequence + ")",
            {"frame in the middle of 15", "", false},
            {"share of triple framing", "", false, true},
            {}};
  const std::size_t windows = use.thresholds.front().shares.size();
  ResourceCurve held{"triple framing", std::vector<double>(windows, 1)};
  std::vector<const ResourceCurve*> curves{&held, &use.interpolation};
  for (const ResourceCurve& curve : use.thresholds) curves.push_back(&curve);
  for (const ResourceCurve* curve : curves) {
    PlotSeries series{curve->name, {}, SeriesStyle::Line};
    for (std::size_t k = 0; k < windows; ++k)
      series.points.push_back({static_cast<double>(k + kWindow_frames / 2), curve->shares[k]});
    plot.series.push_back(series);
  }
  return plot;
}

std::vector<PaperFigure> use_drawings(PaperBench& bench) {
  const std::string sequence = barnyard_sequence().name;
  std::vector<PaperFigure> all;
  for (const auto& [resource, number] : {std::pair{"polygons", FrameNumber(rendered_polygons)},
                                         std::pair{"pixels", FrameNumber(rendered_pixels)}})
    all.push_back({std::string("LS97-22-") + resource,
                   std::string("Fig. 22, ") + resource + ": " + sequence +
                       ", 15-frame moving averages, triple framing = 1",
                   use_plot(use_measured(bench, resource, number, 1), sequence)});
  return all;
}

}  // namespace

ResourceUse resource_use(const std::string& resource, const std::vector<double>& held,
                         const std::vector<double>& interpolated,
                         const std::vector<std::vector<double>>& threshold) {
  const std::vector<double> px = barnyard_thresholds();
  TALISMAN_CHECK_EQ(px.size(), threshold.size());
  const auto sum = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  const std::vector<double> whole = moving_average(held);
  ResourceUse use{resource,
                  {},
                  {"interpolated", shares_of(moving_average(interpolated), whole)},
                  sum(interpolated) / sum(held)};
  for (std::size_t k = 0; k < px.size(); ++k)
    use.thresholds.push_back({formatted("%g px", px[k]), shares_of(moving_average(threshold[k]), whole)});
  return use;
}

Finding below_triple_framing(const ResourceUse& use) {
  Finding finding{"", true, {}};
  for (const ResourceCurve& curve : use.thresholds) {
    const double largest = largest_of(curve.shares);
    finding.same = finding.same && !curve.shares.empty() && largest < 1;  // false for what is not a number
    finding.ours += (finding.ours.empty() ? "at most " : ", ") + fixed(largest, 2) + " at " + curve.name;
    finding.numbers.emplace_back("largest " + curve.name, largest);
  }
  return finding;
}

Finding falling_with_threshold(const ResourceUse& use) {
  Finding finding{"", true, {}};
  double before = HUGE_VAL;
  for (const ResourceCurve& curve : use.thresholds) {
    const double mean = mean_of(curve.shares);
    finding.same = finding.same && !curve.shares.empty() && mean < before;
    before = mean;
    finding.ours += (finding.ours.empty() ? "mean " : ", ") + fixed(mean, 2) + " at " + curve.name;
    finding.numbers.emplace_back("mean " + curve.name, mean);
  }
  return finding;
}

Finding interpolation_costs_the_same(const ResourceUse& use) {
  return {fixed(use.interpolated, 3) + " of it",
          std::abs(use.interpolated - 1) <= kSameCostShare,
          {{"interpolated over held", use.interpolated}}};
}

Item figure_22() {
  Item item{"22", "Fig. 22: barnyard, resource use", {}, use_drawings};
  for (const auto& [resource, number] : {std::pair{"polygons", FrameNumber(rendered_polygons)},
                                         std::pair{"pixels", FrameNumber(rendered_pixels)}}) {
    const std::string what(resource);
    item.claims.push_back(
        use_claim("below-" + what, what + ": thresholds of 0.1 to 0.8 px lie below triple framing",
                  "every 15-frame window of every threshold below 1", what, number, below_triple_framing));
    item.claims.push_back(use_claim("falling-" + what, what + ": the larger the threshold, the less",
                                    "means over the windows fall strictly", what, number,
                                    falling_with_threshold));
    item.claims.push_back(use_claim("interpolated-" + what,
                                    what + ": interpolated triple framing costs as much as held", "to 2 %",
                                    what, number, interpolation_costs_the_same));
    item.claims.back().why = dearer_layer;
  }
  return item;
}

}  // namespace talisman::sequences
