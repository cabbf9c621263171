// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/machine.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "regulator/profile.h"
#include "sequences/experiments/reproduction/moving_average.h"
#include "sequences/experiments/reproduction/paper_sequences.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

double profile_number(std::string_view name) {
  for (const regulator::ProfileNumber& number : regulator::talisman_1996().numbers)
    if (number.name == name) return number.value;
  TALISMAN_CHECK(false && "no such number in the profile");
}

std::vector<double> drawing_ms(const PlannedRun& run) {
  return by_frame(run, [](const FrameLine& line) { return line.modelled_drawing_ms; });
}

std::vector<MachineUse> machine_uses(PaperBench& bench) {
  std::vector<MachineUse> uses;
  std::vector<std::string> names;
  for (const std::string& name : {canyon_sequence().name, barnyard_sequence().name, chicken_sequence().name})
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (const std::string& name : names) {
    bench.plan_all({own_plan(name), reference_plan(name)});
    const PlannedRun& own = bench.plan(own_plan(name));
    uses.push_back({name, own.sprite_depth, drawing_ms(own), drawing_ms(bench.plan(reference_plan(name)))});
  }
  return uses;
}

int count_above(const std::vector<double>& values, double limit) {
  return static_cast<int>(
      std::count_if(values.begin(), values.end(), [=](double v) { return !(v <= limit); }));
}

/// What would bring the frames in?
std::string by_how_much(PaperBench& bench) {
  std::string text;
  for (const MachineUse& use : machine_uses(bench))
    text += (text.empty() ? "" : "; ") + use.name + ": on demand " + fixed(mean_of(use.drawing_ms), 1) +
            " ms a frame in the mean, " + fixed(largest_of(use.drawing_ms), 1) + " at most, all layers " +
            fixed(mean_of(use.reference_ms), 1) + " ms; depth " + fixed(mean_of(use.depth), 2) +
            " in the mean, at most " + fixed(largest_of(use.depth), 2);
  return text;
}

Claim derived(Claim claim) {
  claim.derived = true;
  return claim;
}

Claim of_limits(const char* id, const char* paper, const char* rule, Finding (*test)(const MachineLimits&)) {
  return derived({id, paper, rule, [test](PaperBench&) { return test(machine_limits()); }});
}

Claim of_uses(const char* id, const char* paper, const char* rule,
              Finding (*test)(const std::vector<MachineUse>&, const MachineLimits&)) {
  return derived({id, paper, rule,
                  [test](PaperBench& bench) { return test(machine_uses(bench), machine_limits()); },
                  by_how_much});
}

std::vector<PaperFigure> machine_drawings(PaperBench& bench) {
  Plot plot{"modelled drawing time of the published machine",
            {"frame", "", false},
            {"drawing", "ms", false, true},
            {}};
  const double limit_ms = machine_limits().frame_ms;
  std::size_t longest = 1;
  for (const MachineUse& use : machine_uses(bench)) {
    PlotSeries series{use.name, {}, SeriesStyle::Line};
    for (std::size_t k = 0; k < use.drawing_ms.size(); ++k)
      series.points.push_back({static_cast<double>(k), use.drawing_ms[k]});
    longest = std::max(longest, use.drawing_ms.size());
    plot.series.push_back(series);
  }
  plot.series.push_back(
      {"1/75 s", {{0, limit_ms}, {static_cast<double>(longest - 1), limit_ms}}, SeriesStyle::Line});
  return {{"LS97-machine", "Derived: the time that each frame takes the renderer, drawn on demand", plot}};
}

}  // namespace

MachineLimits machine_limits() {
  const regulator::HardwareProfile& profile = regulator::talisman_1996();
  const double display = profile_number("display width") * profile_number("display height");
  const double refresh = profile_number("refresh");
  return {profile.compositor_pixels_per_s / (display * refresh),
          profile.renderer_pixels_per_s / refresh / display, 1e3 / refresh};
}

Finding limit_of_depth(const MachineLimits& limits) {
  return {fixed(limits.depth, 2), std::abs(limits.depth - 3.1) < 0.05, {{"depth", limits.depth}}};
}

Finding limit_of_screen(const MachineLimits& limits) {
  return {fixed(100 * limits.screen, 1) + " %",
          std::abs(limits.screen - 0.39) < 0.005,
          {{"screen", limits.screen}}};
}

Finding depth_is_kept(const std::vector<MachineUse>& uses, const MachineLimits& limits) {
  Finding finding{"", !uses.empty(), {}};
  for (const MachineUse& use : uses) {
    const int deeper = count_above(use.depth, limits.depth);
    finding.same = finding.same && deeper == 0;
    finding.ours += (finding.ours.empty() ? "" : ", ") + use.name + " at most " +
                    fixed(largest_of(use.depth), 2) +
                    (deeper > 0 ? " (" + std::to_string(deeper) + " frames deeper)" : "");
    finding.numbers.emplace_back(use.name, largest_of(use.depth));
  }
  return finding;
}

Finding fewer_frames_miss(const std::vector<MachineUse>& uses, const MachineLimits& limits) {
  Finding finding{"", !uses.empty(), {}};
  for (const MachineUse& use : uses) {
    const int missed = count_above(use.drawing_ms, limits.frame_ms),
              all = count_above(use.reference_ms, limits.frame_ms);
    finding.same = finding.same && (missed < all || all == 0) && missed <= all;
    finding.ours += (finding.ours.empty() ? "" : ", ") + use.name + " " + std::to_string(missed) + " of " +
                    std::to_string(use.drawing_ms.size()) + ", all layers " + std::to_string(all);
    finding.numbers.emplace_back(use.name + " on demand", missed);
    finding.numbers.emplace_back(use.name + " all layers", all);
  }
  return finding;
}

Item published_machine() {
  return {"machine",
          "Footnote 1 and the published machine",
          {of_limits("depth", "320 Mpix/s: depth 3.1 at 1344x1024, 75 Hz", "to 0.05", limit_of_depth),
           of_limits("screen", "40 Mpix/s: 39 % of a screen a frame", "to 0.5 %", limit_of_screen),
           of_uses("depth-kept", "the compositor keeps up with all sprites",
                   "no frame deeper than that in the mean", depth_is_kept),
           of_uses("missed", "frames that take the renderer more than 1/75 s",
                   "fewer on demand than with all layers", fewer_frames_miss)},
          machine_drawings};
}

}  // namespace talisman::sequences
