// SPDX-License-Identifier: Apache-2.0
#include "regulator/plan.h"

#include <cmath>
#include <cstdio>

#include "layers/check.h"
#include "regulator/policies.h"

namespace talisman::regulator {

std::string_view name(Policy policy) {
  switch (policy) {
    case Policy::Direct:
      return "direct";
    case Policy::Reference:
      return "reference";
    case Policy::Hold:
      return "hold";
    case Policy::Interpolate:
      return "interpolate";
    case Policy::Threshold:
      return "threshold";
  }
  return "?";
}

std::optional<Policy> policy_from_name(std::string_view text) {
  for (const Policy policy : kAllPolicies)
    if (name(policy) == text) return policy;
  return std::nullopt;
}

std::string_view name(Action action) {
  switch (action) {
    case Action::Reuse:
      return "reuse";
    case Action::Rerender:
      return "rerender";
    case Action::Drop:
      return "drop";
  }
  return "?";
}

std::string comparison(const char* what, double value, const char* relation, double limit, const char* unit) {
  char text[160];
  std::snprintf(text, sizeof text, "%s %.4g %s %.4g%s%s", what, value, relation, limit, *unit ? " " : "",
                unit);
  return text;
}

LayerDecision rerender(const LayerAssessment& layer, std::string reason) {
  LayerDecision decision{layer.layer, Action::Rerender, std::move(reason), {}, 0, 0, layer.cost};
  decision.warp_geometric_px = layer.has_sprite ? layer.fiducials.geometric.px : 0;
  return decision;
}

LayerDecision reuse(const LayerAssessment& layer, std::string reason) {
  const double error = layer.fiducials.geometric.px;
  return {layer.layer, Action::Reuse, std::move(reason), layer.fitted.warp, error, error, {}};
}

LayerDecision reuse_in_place(const LayerAssessment& layer, std::string reason) {
  return {layer.layer, Action::Reuse,           std::move(reason),
          {},          layer.held_geometric_px, layer.fiducials.geometric.px,
          {}};
}

LayerDecision decide_every_frame(const LayerAssessment& layer, std::string reason) {
  return rerender(layer, std::move(reason));
}

namespace {

LayerDecision decide(int frame, const LayerAssessment& layer, const RegulatorOptions& options) {
  if (!layer.in_view) return {layer.layer, Action::Drop, "out_of_view", {}, 0, 0, {}};
  if (options.policy == Policy::Direct) return decide_every_frame(layer, "policy: direct");
  if (!layer.has_sprite) return rerender(layer, "first_appearance");
  switch (options.policy) {
    case Policy::Direct:
    case Policy::Reference:
      return decide_every_frame(layer, "policy: reference");
    case Policy::Hold:
      return decide_hold(frame, layer, options);
    case Policy::Interpolate:
      return decide_interpolate(frame, layer, options);
    case Policy::Threshold:
      return decide_threshold(layer, options);
  }
  return {};
}

}  // namespace

FramePlan regulate(int frame, std::span<const LayerAssessment> assessments, const RegulatorOptions& options) {
  TALISMAN_CHECK_EQ(first_defect(options), std::string());
  FramePlan plan{frame, {}};
  plan.decisions.reserve(assessments.size());
  for (const LayerAssessment& layer : assessments) plan.decisions.push_back(decide(frame, layer, options));
  return plan;
}

std::string first_defect(const RegulatorOptions& o) {
  const auto broken = [](const char* option, double value, const char* rule) {
    char text[160];
    std::snprintf(text, sizeof text, "%s is %g, must be %s", option, value, rule);
    return std::string(text);
  };
  // The comparisons are written so that NaN breaks each rule.
  if (o.hold_frames < 1) return broken("hold_frames", o.hold_frames, "at least 1");
  if (!(o.geometric_px >= 0)) return broken("geometric_px", o.geometric_px, "at least 0");
  if (!(o.magnification == 0 || o.magnification >= 1))
    return broken("magnification", o.magnification, "0 (off) or at least 1");
  if (!(o.minification >= 0 && o.minification <= 1))
    return broken("minification", o.minification, "0 (off) to 1");
  if (!(o.anisotropy == 0 || o.anisotropy >= 1))
    return broken("anisotropy", o.anisotropy, "0 (off) or at least 1");
  if (std::isnan(o.uncovered_px)) return broken("uncovered_px", o.uncovered_px, "a number (negative: off)");
  return {};
}

double expected_reuse_frames(const RegulatorOptions& options, double threshold_default) {
  switch (options.policy) {
    case Policy::Direct:
    case Policy::Reference:
      return 0;
    case Policy::Hold:
      return 0;  // shown where it was: nothing new can come into view
    case Policy::Interpolate:
      return options.hold_frames - 1;
    case Policy::Threshold:
      return options.geometric_px > 0 ? threshold_default : 0;
  }
  return 0;
}

}  // namespace talisman::regulator
