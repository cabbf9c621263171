// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/figure_23.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/reproduction/moving_average.h"
#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kBeat_frames = 3;
constexpr double kBeatsInShape = 0.8;
constexpr double kLessWrong = 0.5;
/// What rounding alone can leave of an error of nothing.
constexpr double kNothing_px = 1e-6;

double mean_error_px(const FrameLine& line) { return line.error.mean_px; }

double largest_of_layers(const Summary& summary) {
  double largest = 0;
  for (const LayerSummary& layer : summary.layers) largest = std::max(largest, layer.max_geometric_px);
  return largest;
}

PixelErrors errors_measured(PaperBench& bench, double speed) {
  const BarnyardPlans plans = barnyard_plans(bench, speed);
  PixelErrors errors{by_frame(*plans.held, mean_error_px), by_frame(*plans.interpolated, mean_error_px), {}};
  for (std::size_t k = 0; k < plans.thresholds.size(); ++k)
    errors.thresholds.push_back({barnyard_thresholds()[k], by_frame(*plans.thresholds[k], mean_error_px),
                                 largest_of_layers(plans.thresholds[k]->summary)});
  return errors;
}

std::string errors_at_other_speeds(PaperBench& bench, Finding (*rule)(const PixelErrors&)) {
  std::string text;
  for (const double speed : {0.5, 2.0, 4.0}) {
    const Finding finding = rule(errors_measured(bench, speed));
    text += (text.empty() ? "at " : "; at ") + formatted("%g", speed) + " of the speed " +
            (finding.same ? "yes: " : "no: ") + finding.ours;
  }
  return text;
}

Claim error_claim(const char* id, const char* paper, const char* rule, Finding (*test)(const PixelErrors&)) {
  Claim claim{id, paper, rule, [=](PaperBench& bench) { return test(errors_measured(bench, 1)); },
              [=](PaperBench& bench) { return errors_at_other_speeds(bench, test); }};
  claim.sequence = barnyard_sequence().name;
  claim.must = barnyard_sequence().is_papers_own;
  return claim;
}

PlotSeries error_series(const std::string& name, const std::vector<double>& px) {
  PlotSeries series{name, {}, SeriesStyle::Line};
  for (std::size_t k = 0; k < px.size(); ++k) series.points.push_back({static_cast<double>(k), px[k]});
  return series;
}

/// Of so many frames from the middle on a saw-tooth can be seen as one.
constexpr std::size_t kClose_frames = 45;

std::vector<double> from_the_middle(const std::vector<double>& values) {
  const std::size_t first = values.size() > kClose_frames ? (values.size() - kClose_frames) / 2 : 0;
  return {values.begin() + first, values.begin() + std::min(first + kClose_frames, values.size())};
}

Plot error_plot(const PixelErrors& errors, const std::string& title, bool close) {
  const auto shown = [&](const std::vector<double>& px) { return close ? from_the_middle(px) : px; };
  Plot plot{title,
            {close ? "frame, of 45 in the middle" : "frame", "", false},
            {"mean error of the layers", "px", false, true},
            {}};
  plot.series.push_back(error_series("triple framing", shown(errors.held_px)));
  plot.series.push_back(error_series("interpolated", shown(errors.interpolated_px)));
  for (const ThresholdError& threshold : errors.thresholds)
    plot.series.push_back(error_series(formatted("%g px", threshold.threshold_px), shown(threshold.mean_px)));
  return plot;
}

std::vector<PaperFigure> error_drawings(PaperBench& bench) {
  const std::string name = barnyard_sequence().name;
  const PixelErrors errors = errors_measured(bench, 1);
  return {{"LS97-23", "Fig. 23: " + name + ", mean over the layers of each frame",
           error_plot(errors, "pixel error (" + name + ")", false)},
          {"LS97-23-close", "Fig. 23, closer: 45 frames of the same",
           error_plot(errors, "pixel error, closer (" + name + ")", true)}};
}

}  // namespace

SawTooth saw_tooth_of(const std::vector<double>& held_px) {
  SawTooth tooth;
  double middle = 0, full = 0;
  for (std::size_t k = 0; k + kBeat_frames <= held_px.size(); k += kBeat_frames) {
    tooth.largest_at_beat_px = std::max(tooth.largest_at_beat_px, held_px[k]);
    const double here = held_px[k + 1], last = held_px[k + 2];
    middle += here;
    full += last;
    if (!(last > kNothing_px)) continue;
    ++tooth.beats;
    tooth.beats_in_shape += std::abs(here / last / 0.5 - 1) <= kSawTooth;
  }
  tooth.middle = full > 0 ? middle / full : 0;
  return tooth;
}

Finding is_saw_tooth(const PixelErrors& errors) {
  const SawTooth tooth = saw_tooth_of(errors.held_px);
  return {"0, " + fixed(tooth.middle, 2) + ", 1; at most " + formatted("%.2g", tooth.largest_at_beat_px) +
              " px where drawn; " + std::to_string(tooth.beats_in_shape) + " of " +
              std::to_string(tooth.beats) + " beats within 20 %",
          tooth.beats > 0 && tooth.largest_at_beat_px <= kNothing_px &&
              std::abs(tooth.middle / 0.5 - 1) <= kSawTooth &&
              tooth.beats_in_shape >= kBeatsInShape * tooth.beats,
          {{"middle", tooth.middle},
           {"largest_at_beat_px", tooth.largest_at_beat_px},
           {"beats", tooth.beats},
           {"beats_in_shape", tooth.beats_in_shape}}};
}

Finding thresholds_are_kept(const PixelErrors& errors) {
  Finding finding{"", !errors.thresholds.empty(), {}};
  for (const ThresholdError& each : errors.thresholds) {
    const double largest = std::max(largest_of(each.mean_px), each.largest_px);
    finding.same = finding.same && largest <= each.threshold_px;
    finding.ours += (finding.ours.empty() ? "at most " : ", ") + fixed(largest_of(each.mean_px), 3) +
                    " (a layer " + fixed(each.largest_px, 3) + ")" +
                    formatted(" at %g px", each.threshold_px);
    finding.numbers.emplace_back(formatted("largest mean %g px", each.threshold_px),
                                 largest_of(each.mean_px));
    finding.numbers.emplace_back(formatted("largest layer %g px", each.threshold_px), each.largest_px);
  }
  return finding;
}

Finding premise_holds(const PixelErrors& errors) {
  const double largest = largest_of(errors.held_px);
  const double threshold = errors.thresholds.empty() ? HUGE_VAL : errors.thresholds.back().threshold_px;
  return {
      "triple framing at most " + fixed(largest, 2) + " px, in the mean " + fixed(mean_of(errors.held_px), 2),
      largest > threshold && std::isfinite(largest),
      {{"largest_px", largest}, {"mean_px", mean_of(errors.held_px)}}};
}

Finding interpolation_is_better(const PixelErrors& errors) {
  const double held = mean_of(errors.held_px), interpolated = mean_of(errors.interpolated_px);
  return {"mean " + fixed(interpolated, 3) + " px against " + fixed(held, 3),
          interpolated <= kLessWrong * held && held > 0,
          {{"interpolated_px", interpolated}, {"held_px", held}}};
}

Item figure_23() {
  return {"23",
          "Fig. 23: barnyard, pixel error",
          {error_claim("saw-tooth", "triple framing cycles 0, half, full",
                       "0, ½ ± 20 %, 1 in sum and in 4 of 5 beats", is_saw_tooth),
           error_claim("kept", "thresholds stay below themselves", "no frame's mean, no layer above",
                       thresholds_are_kept),
           error_claim("premise", "each threshold is below triple framing's largest error",
                       "a frame's mean above 0.8 px", premise_holds),
           error_claim("interpolated", "the most dramatic gain is interpolation", "mean error at most half",
                       interpolation_is_better)},
          error_drawings};
}

}  // namespace talisman::sequences
