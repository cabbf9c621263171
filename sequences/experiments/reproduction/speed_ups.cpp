// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/speed_ups.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr double kLeastSpeedUp = 3, kMostMoving = 5, kMostFixed = 10;

using RenderedOfAll = std::function<std::pair<double, double>(const FrameLine&)>;  ///< rendered, reference

std::pair<double, double> polygon_counts(const FrameLine& line) {
  return {static_cast<double>(line.polygons.rendered), static_cast<double>(line.polygons.reference)};
}
std::pair<double, double> pixel_counts(const FrameLine& line) {
  return {static_cast<double>(line.pixels.rendered), static_cast<double>(line.pixels.reference)};
}

double factor_of(const PlannedRun& run, const RenderedOfAll& counts) {
  double rendered = 0, reference = 0;
  for (const FrameLine& line : run.summary.frames) {
    const auto [part, whole] = counts(line);
    rendered += part;
    reference += whole;
  }
  return rendered > 0 ? reference / rendered : HUGE_VAL;
}

std::vector<SpeedUp> speed_ups(PaperBench& bench, const std::vector<PlanOf>& plans,
                               const RenderedOfAll& counts) {
  bench.plan_all(plans);
  std::vector<SpeedUp> all;
  for (const PlanOf& of : plans) all.push_back({of.sequence, factor_of(bench.plan(of), counts)});
  return all;
}

std::vector<PlanOf> moving_plans() {
  std::vector<PlanOf> plans;
  for (const std::string& name : {canyon_sequence().name, barnyard_sequence().name, chicken_sequence().name})
    if (!name.empty() && std::find(plans.begin(), plans.end(), own_plan(name)) == plans.end())
      plans.push_back(own_plan(name));
  return plans;
}

/// Those in which something moves before a camera that stands.
std::vector<PlanOf> fixed_plans() {
  std::vector<PlanOf> plans;
  for (const std::string& name : {chicken_sequence().name, std::string("stage"), std::string("carousel")}) {
    if (name.empty()) continue;
    plans.push_back(own_plan(name));
    plans.back().fixed_camera = true;
  }
  return plans;
}

/// At other thresholds of the geometric error, the same.
std::string speed_ups_at_other_thresholds(PaperBench& bench, const std::vector<PlanOf>& plans,
                                          const RenderedOfAll& counts) {
  std::string text;
  for (const PlanOf& of : plans) {
    text += (text.empty() ? "" : "; ") + of.sequence;
    std::vector<PlanOf> others;
    for (const double px : {0.25, 1.0, 4.0, 16.0}) {
      others.push_back(threshold_plan(of.sequence, px));
      others.back().fixed_camera = of.fixed_camera;
    }
    bench.plan_all(others);
    for (const PlanOf& other : others)
      text += formatted(" %g px ", other.value) + fixed(factor_of(bench.plan(other), counts), 1);
  }
  return text;
}

Claim speed_claim(const std::string& id, const std::string& paper, std::vector<PlanOf> (*plans)(),
                  double most, const RenderedOfAll& counts) {
  return {
      id, paper, "all of " + formatted("%g to %g", kLeastSpeedUp, most),
      [=](PaperBench& bench) { return all_in_range(speed_ups(bench, plans(), counts), kLeastSpeedUp, most); },
      [=](PaperBench& bench) { return speed_ups_at_other_thresholds(bench, plans(), counts); }};
}

}  // namespace

Finding all_in_range(const std::vector<SpeedUp>& speed_ups, double least, double most) {
  Finding finding{"", !speed_ups.empty(), {}};
  for (const SpeedUp& each : speed_ups) {
    finding.same = finding.same && each.factor >= least && each.factor <= most;
    finding.ours += (finding.ours.empty() ? "" : ", ") + each.name + " " +
                    (std::isfinite(each.factor) ? fixed(each.factor, 2) : "without end");
    finding.numbers.emplace_back(each.name, each.factor);
  }
  return finding;
}

Item moving_cameras() {
  return {
      "7",
      "Section 7: speed-up with a moving camera",
      {speed_claim("polygons", "typically 3 to 5, in polygons", moving_plans, kMostMoving, polygon_counts),
       speed_claim("pixels", "and in pixels", moving_plans, kMostMoving, pixel_counts)}};
}

Item fixed_cameras() {
  return {"8",
          "Section 8 and footnote 12: speed-up with a fixed camera",
          {speed_claim("polygons", "3 to 10 in all, in polygons", fixed_plans, kMostFixed, polygon_counts),
           speed_claim("pixels", "and in pixels", fixed_plans, kMostFixed, pixel_counts)}};
}

}  // namespace talisman::sequences
