// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/settings.h"

#include <cmath>
#include <cstdio>

#include "sequences/experiments/sampled_frames.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;
using regulator::RegulatorOptions;

/// `base` under another policy, with nothing left of the limits that its author may have set for his own.
RegulatorOptions under(const RegulatorOptions& base, Policy policy) {
  RegulatorOptions options = base;
  options.policy = policy;
  options.budget.polygons = options.budget.pixels = options.budget.chunks = regulator::kNoLimit;
  options.budget.ms = regulator::kNoLimitMs;
  return options;
}

void add_periods(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base, Policy policy) {
  for (const int n : compared_holds()) {
    RegulatorOptions options = under(base, policy);
    options.hold_frames = n;
    settings.push_back({std::string(regulator::name(policy)), "frames", double(n), options});
  }
}

void add_thresholds(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base, Policy policy,
                    const std::string& series) {
  for (const double px : compared_thresholds()) {
    RegulatorOptions options = under(base, policy);
    options.thresholds.geometric_px = px;
    options.lookahead.frames = kComparedLookahead;
    settings.push_back({series, "px", px, options});
  }
}

/// Less of a sprite than all of it: its chunks, or pieces of its layer.
void add_parts_of_sprites(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base) {
  for (const double px : compared_thresholds()) {
    RegulatorOptions options = under(base, Policy::Threshold);
    options.thresholds.geometric_px = px;
    options.refresh = regulator::Refresh::Chunks;
    settings.push_back({"threshold chunks", "px", px, options});
  }
  for (const int pieces : {2, 4, 8})
    for (const double px : {1.0, 4.0}) {
      RegulatorOptions options = under(base, Policy::Threshold);
      options.thresholds.geometric_px = px;
      settings.push_back({"threshold in " + std::to_string(pieces), "px", px, options, pieces});
    }
}

/// What is done against the steps of sprites that are drawn again [LS97 8].
void add_remedies(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base) {
  for (const int n : compared_holds()) {
    RegulatorOptions options = under(base, Policy::Interpolate);
    options.hold_frames = n;
    options.stagger = true;
    settings.push_back({"interpolate staggered", "frames", double(n), options});
  }
  for (const int k : {1, 2, 4}) {
    RegulatorOptions options = under(base, Policy::Threshold);
    options.blend_frames = k;
    settings.push_back({"threshold blended", "frames", double(k), options});
  }
}

void add_settling(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base) {
  for (const int n : {1, 4, 16}) {
    RegulatorOptions options = under(base, Policy::Threshold);
    options.settle_frames = n;
    settings.push_back({"threshold settled", "frames", double(n), options});
  }
}

void add_budgets(std::vector<RegulatorSetting>& settings, const RegulatorOptions& base,
                 double polygons_per_frame, regulator::ChoiceRule choice, const std::string& series) {
  for (const double percent : compared_budgets()) {
    RegulatorOptions options = under(base, Policy::Budget);
    options.budget.polygons = std::llround(polygons_per_frame * percent / 100);
    options.budget.choice = choice;
    settings.push_back({series, "%", percent, options});
  }
}

}  // namespace

std::string RegulatorSetting::knob() const {
  char text[64] = "";
  if (unit == "frames")
    std::snprintf(text, sizeof text, "N %g", value);
  else if (!unit.empty())
    std::snprintf(text, sizeof text, "%g %s", value, unit.c_str());
  return text;
}

std::string RegulatorSetting::words() const { return unit.empty() ? series : series + " " + knob(); }

std::vector<double> compared_thresholds() { return {0.25, 0.5, 1, 2, 4, 8}; }
std::vector<double> compared_budgets() { return {5, 10, 20, 40, 80}; }

std::vector<RegulatorSetting> regulator_settings(const RegulatorOptions& base, double polygons_per_frame) {
  std::vector<RegulatorSetting> settings{{"reference", "", 0, under(base, Policy::Reference)}};
  add_periods(settings, base, Policy::Hold);
  add_periods(settings, base, Policy::Interpolate);
  add_thresholds(settings, base, Policy::Threshold, "threshold");
  add_parts_of_sprites(settings, base);
  add_settling(settings, base);
  add_remedies(settings, base);
  add_thresholds(settings, base, Policy::Lookahead, "lookahead " + std::to_string(kComparedLookahead));
  add_thresholds(settings, base, Policy::Oracle, "oracle");
  add_budgets(settings, base, polygons_per_frame, regulator::ChoiceRule::Paper, "budget");
  add_budgets(settings, base, polygons_per_frame, regulator::ChoiceRule::Best, "budget best");
  return settings;
}

}  // namespace talisman::sequences
