// SPDX-License-Identifier: Apache-2.0
#include "regulator/decision.h"

#include <charconv>
#include <cstdio>
#include <utility>

#include "regulator/policies.h"

namespace talisman::regulator {

std::string comparison(const char* what, double value, const char* relation, double limit, const char* unit) {
  // As "%.4g" prints, at a fraction of its time: every layer has a reason in every frame.
  std::string text;
  text.reserve(64);
  const auto add_number = [&text](double v) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, v, std::chars_format::general, 4).ptr;
    text.append(digits, end);
  };
  text.append(what).append(1, ' ');
  add_number(value);
  text.append(1, ' ').append(relation).append(1, ' ');
  add_number(limit);
  if (*unit) text.append(1, ' ');
  return text.append(unit);
}

LayerDecision drop(const LayerAssessment& layer) {
  return {layer.layer, Action::Drop, "out_of_view", {}, 0, 0, {}, -1};
}

LayerDecision rerender(const LayerAssessment& layer, std::string reason) {
  LayerDecision decision{layer.layer, Action::Rerender, std::move(reason), {}, 0, 0, layer.cost, -1};
  decision.warp_geometric_px = layer.has_sprite ? layer.fiducials.geometric.px : 0;
  decision.resolution = layer.resolution;
  return decision;
}

LayerDecision draw_on_beat(const LayerAssessment& layer, const std::string& policy) {
  if (!layer.in_view) return drop(layer);
  return rerender(layer, layer.has_sprite ? policy : "first_appearance");
}

LayerDecision wait_for_beat(const LayerAssessment& layer, const std::string& policy) {
  LayerDecision decision = drop(layer);
  if (layer.in_view) decision.reason = policy + ", first shown on the next beat";
  return decision;
}

LayerDecision reuse(const LayerAssessment& layer, std::string reason) {
  const double error = layer.fiducials.geometric.px;
  LayerDecision decision{layer.layer, Action::Reuse, std::move(reason), layer.fitted.warp, error, error, {},
                         -1};
  decision.shown_color = layer.fiducials.photometric.multiplier;
  decision.resolution = layer.resolution_then;
  return decision;
}

LayerDecision reuse_in_place(const LayerAssessment& layer, std::string reason) {
  LayerDecision decision = reuse(layer, std::move(reason));
  decision.shown_warp = {};
  decision.shown_color = layers::dvec3(1.0);
  decision.shown_geometric_px = layer.held_geometric_px;
  return decision;
}

LayerDecision keep_old(const LayerAssessment& layer, std::string reason) {
  if (layer.identical || has_sound_fit(layer)) return reuse(layer, std::move(reason));
  return reuse_in_place(layer, reason + ", no warp");
}

std::string at_resolution(double resolution) {
  if (resolution == 1) return {};
  char text[40];
  std::snprintf(text, sizeof text, "; resolution %.3g", resolution);
  return text;
}

LayerDecision decide_every_frame(const LayerAssessment& layer, std::string reason) {
  return rerender(layer, std::move(reason));
}

}  // namespace talisman::regulator
