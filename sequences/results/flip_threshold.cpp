// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/flip_threshold.h"

#include <algorithm>

#include "sequences/files/number_text.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/explanation.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {

namespace {

using regulator::Thresholds;

constexpr double kToEachSide = 0.01;

/// The limits of fiducials, by the names that settings have.
double* limit_of(Thresholds& thresholds, const std::string& name) {
  if (name == "geometric_px") return &thresholds.geometric_px;
  if (name == "photometric") return &thresholds.photometric;
  if (name == "light_angle_rad") return &thresholds.light_angle_rad;
  if (name == "magnification") return &thresholds.magnification;
  if (name == "minification") return &thresholds.minification;
  if (name == "anisotropy") return &thresholds.anisotropy;
  if (name == "uncovered_px") return &thresholds.uncovered_px;
  if (name == "turned_px") return &thresholds.turned_px;
  if (name == "shadow_map_px") return &thresholds.shadow_map_px;
  return nullptr;
}

bool is_least(const std::string& name) { return name == "minification"; }

/// Is the layer drawn in the frame, if that is planned with other thresholds than the frames before it?
bool is_drawn_with(const Sequence& sequence, const Settings& settings, const Thresholds& thresholds,
                   int frame, const std::string& layer) {
  Settings other = settings;
  other.regulator.thresholds = thresholds;
  const Pipeline before = make_pipeline(*sequence.scene, sequence.layers, settings);
  const Pipeline then = make_pipeline(*sequence.scene, sequence.layers, other);
  PipelineState state(before);
  for (int k = 0; k < frame; ++k) step(before, state, k, nullptr);
  const FrameReport report = step(then, state, frame, nullptr);
  for (const DecisionRow& row : decision_rows(state, report))
    if (row.name == layer) return row.decision.action == regulator::Action::Rerender;
  return false;
}

/// Each limit `share` of itself looser (or, below 0, stricter) than where the decision changes.
Thresholds moved(Thresholds thresholds, const std::vector<FlipLimit>& limits, double share) {
  for (const FlipLimit& limit : limits)
    *limit_of(thresholds, limit.name) = limit.at * (is_least(limit.name) ? 1 - share : 1 + share);
  return thresholds;
}

/// With all limits looser it is kept, and with any one of them stricter it is drawn.
bool is_flip(const Sequence& sequence, const Settings& settings, const std::vector<FlipLimit>& limits,
             int frame, const std::string& layer) {
  const Thresholds looser = moved(settings.regulator.thresholds, limits, kToEachSide);
  if (is_drawn_with(sequence, settings, looser, frame, layer)) return false;
  return std::all_of(limits.begin(), limits.end(), [&](const FlipLimit& limit) {
    return is_drawn_with(sequence, settings, moved(looser, {limit}, -kToEachSide), frame, layer);
  });
}

/// By which the layer divides the setting.
double weight_of(const FiducialFinding& finding, const LayerHistory& layer) {
  const nlohmann::ordered_json::json_pointer weight("/fiducials/geometric_weight");
  if (finding.setting != "geometric_px" || !layer.line.contains(weight)) return 1;
  return layer.line.at(weight).get<double>();
}

}  // namespace

FlipThreshold flip_threshold_of(const Sequence& sequence, const Settings& settings,
                                const LayerHistory& layer) {
  FlipThreshold flip;
  const std::string decision = layer.line.at("decision").get<std::string>();
  flip.was_drawn = decision == "rerender";
  if (decision == "drop") return flip;
  for (const FiducialFinding& finding : findings_of(layer.line, json_of(settings))) {
    if (finding.setting.empty() || finding.limit.empty() || finding.value.empty()) continue;
    const bool decides = flip.was_drawn ? finding.is_beyond : finding.setting == "geometric_px";
    if (decides)
      flip.limits.push_back({finding.setting, weight_of(finding, layer) * std::stod(finding.value)});
  }
  const auto has_room = [](const FlipLimit& limit) { return limit.at > 0; };
  if (!std::all_of(flip.limits.begin(), flip.limits.end(), has_room)) flip.limits.clear();
  if (flip.limits.empty()) return flip;
  flip.is_proved = is_flip(sequence, settings, flip.limits, layer.line.at("frame").get<int>(), layer.layer);
  return flip;
}

std::string text_of(const FlipThreshold& flip) {
  if (flip.limits.empty()) return "no threshold decides about it in this frame";
  std::string limits;
  for (const FlipLimit& limit : flip.limits)
    limits += (limits.empty() ? "" : " and ") + limit.name + " " + formatted("%.6g", limit.at);
  if (!flip.is_proved)
    return "would be decided by " + limits + ", but a plan with 1 % more and less does not show it";
  return (flip.was_drawn ? "kept from " + limits + " on" : "drawn below " + limits) +
         " (planned: kept at 1 % looser, drawn at 1 % stricter)";
}

}  // namespace talisman::sequences
