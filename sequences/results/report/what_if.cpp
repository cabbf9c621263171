// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/what_if.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sequences/files/atomic_file.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

Json what_if_plan(double factor, double geometric_px, const Summary& summary) {
  double max_px = 0;
  const double ms = summary.total(&FrameLine::modelled_drawing_ms);
  for (const LayerSummary& layer : summary.layers) max_px = std::max(max_px, layer.max_geometric_px);
  const auto frames = std::max(1, summary.frame_count());
  return {{"factor", factor},
          {"geometric_px", geometric_px},
          {"mean_update_rate", summary.mean_update_rate()},
          {"polygons_rendered", summary.polygons_rendered()},
          {"pixels_rendered", summary.pixels_rendered()},
          {"modelled_drawing_ms", ms / frames},
          {"max_geometric_px", max_px}};
}

}  // namespace

bool has_threshold(const Settings& settings) {
  const regulator::Policy policy = settings.regulator.policy;
  return (policy == regulator::Policy::Threshold || policy == regulator::Policy::Lookahead) &&
         settings.regulator.thresholds.geometric_px > 0;
}

void write_what_if(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                   const Summary& now, const std::string& folder) {
  write_what_if(what_if_plans(sequence, settings, range), now, folder);
}

Json what_if_plans(const Sequence& sequence, const Settings& settings, const FrameRange& range) {
  const double threshold_px = settings.regulator.thresholds.geometric_px;
  const auto plan = [&](double factor) {
    Settings other = settings;
    other.regulator.thresholds.geometric_px = factor * threshold_px;
    return what_if_plan(factor, factor * threshold_px, planned(sequence, other, range));
  };
  return {{"geometric_px", threshold_px}, {"half", plan(0.5)}, {"twice", plan(2)}};
}

void write_what_if(const Json& plans, const Summary& now, const std::string& folder) {
  const Json json = {
      {"schema", "talisman.what_if/1"},
      {"plans", {plans.at("half"), what_if_plan(1, plans.at("geometric_px"), now), plans.at("twice")}}};
  write_text_atomically(folder + "/what-if.json", json.dump(2) + "\n");
}

}  // namespace talisman::sequences
