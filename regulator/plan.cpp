// SPDX-License-Identifier: Apache-2.0
#include "regulator/plan.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "layers/check.h"
#include "regulator/budget.h"
#include "regulator/decision.h"
#include "regulator/lod/decide_lod.h"
#include "regulator/policies.h"
#include "regulator/shadow_maps.h"

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
    case Policy::Budget:
      return "budget";
    case Policy::Lookahead:
      return "lookahead";
    case Policy::Oracle:
      return "oracle";
    case Policy::Predictive:
      return "predictive";
  }
  return "?";
}

std::optional<Policy> policy_from_name(std::string_view text) {
  for (const Policy policy : kAllPolicies)
    if (name(policy) == text) return policy;
  return std::nullopt;
}

std::string_view name(ChoiceRule rule) { return rule == ChoiceRule::Best ? "best" : "paper"; }

std::optional<ChoiceRule> choice_rule_from_name(std::string_view text) {
  for (const ChoiceRule rule : kAllChoiceRules)
    if (name(rule) == text) return rule;
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
    case Action::Refresh:
      return "refresh";
  }
  return "?";
}

namespace {

LayerDecision decide(const FrameBeat& beat, const LayerAssessment& layer, const RegulatorOptions& options) {
  if (options.policy == Policy::Hold) return decide_hold(beat, layer, options);
  if (options.policy == Policy::Interpolate) return decide_interpolate(beat, layer, options);
  if (!layer.in_view) return drop(layer);
  if (options.policy == Policy::Direct) return decide_every_frame(layer, "policy: direct");
  // What of it is drawn follows from the motion ahead, of which an assessment knows nothing.
  if (options.policy == Policy::Predictive) return decide_every_frame(layer, "policy: predictive");
  if (!layer.has_sprite) return rerender(layer, "first_appearance");
  switch (options.policy) {
    case Policy::Direct:
    case Policy::Reference:
      return decide_every_frame(layer, "policy: reference");
    case Policy::Threshold:
    case Policy::Lookahead:  // whether to draw again; as of which instant is chosen with the states at hand
    case Policy::Oracle:
      return decide_threshold(layer, options);
    case Policy::Hold:
    case Policy::Interpolate:  // decided above
    case Policy::Predictive:
    case Policy::Budget:  // decides over all layers at once
      break;
  }
  return {};
}

}  // namespace

bool FrameBeat::drew(const LayerAssessment& layer) const {
  return layer.has_sprite && layer.frames_since_render == std::abs(frame - last_beat);
}

bool keeps_beat(const RegulatorOptions& options) {
  return options.policy == Policy::Hold || (options.policy == Policy::Interpolate && !options.stagger);
}

bool blends(const RegulatorOptions& options) {
  if (options.blend_frames < 1) return false;
  switch (options.policy) {
    case Policy::Interpolate:
    case Policy::Threshold:
    case Policy::Lookahead:
    case Policy::Oracle:
      return true;
    case Policy::Direct:
    case Policy::Reference:
    case Policy::Hold:    // nothing is carried: the old sprite would stand beside the fresh one
    case Policy::Budget:  // which would have to be spent on fades, too
    case Policy::Predictive:
      return false;
  }
  return false;
}

FrameBeat regular_beat(int frame, const RegulatorOptions& options) {
  return {frame, frame - frame % options.hold_frames};
}

FramePlan regulate(int frame, std::span<const LayerAssessment> assessments, const RegulatorOptions& options) {
  TALISMAN_CHECK_EQ(first_defect(options), std::string());
  return regulate(regular_beat(frame, options), assessments, options);
}

FramePlan regulate(const FrameBeat& beat, std::span<const LayerAssessment> assessments,
                   const RegulatorOptions& options, std::span<const MapAssessment> maps, LodSolver* solver) {
  TALISMAN_CHECK_EQ(first_defect(options), std::string());
  if (chooses_levels(options) && options.lod.by == LodSelector::Optimise)
    return decide_lod(beat.frame, assessments, options, maps, solver);
  FramePlan plan{beat.frame, {}, {}, {}};
  if (options.policy == Policy::Budget) {
    BudgetDecisions decided = decide_budget(assessments, options, maps);
    plan.decisions = std::move(decided.layers);
    plan.maps = std::move(decided.maps);
    if (chooses_levels(options)) say_levels(assessments, plan.decisions);
    return plan;
  }
  plan.decisions.reserve(assessments.size());
  for (const LayerAssessment& layer : assessments) plan.decisions.push_back(decide(beat, layer, options));
  plan.maps = decide_maps(maps, plan.decisions, options);
  show_held_maps(maps, plan.maps, plan.decisions);
  if (chooses_levels(options)) say_levels(assessments, plan.decisions);
  return plan;
}

namespace {

std::string broken(const char* option, double value, const char* rule) {
  char text[160];
  std::snprintf(text, sizeof text, "%s is %g, must be %s", option, value, rule);
  return text;
}

// The comparisons are written so that NaN breaks each rule.

std::string first_defect(const Thresholds& t) {
  if (!(t.geometric_px >= 0)) return broken("geometric_px", t.geometric_px, "at least 0");
  if (!(t.magnification == 0 || t.magnification >= 1))
    return broken("magnification", t.magnification, "0 (off) or at least 1");
  if (!(t.minification >= 0 && t.minification <= 1))
    return broken("minification", t.minification, "0 (off) to 1");
  if (!(t.anisotropy == 0 || t.anisotropy >= 1))
    return broken("anisotropy", t.anisotropy, "0 (off) or at least 1");
  if (std::isnan(t.uncovered_px)) return broken("uncovered_px", t.uncovered_px, "a number (negative: off)");
  if (!(t.turned_px >= 0)) return broken("turned_px", t.turned_px, "at least 0 (0: off)");
  if (!(t.photometric >= 0)) return broken("photometric", t.photometric, "at least 0 (0: off)");
  if (!(t.shadow_map_px >= 0)) return broken("shadow_map_px", t.shadow_map_px, "at least 0");
  if (!(t.light_angle_rad >= 0 && t.light_angle_rad <= std::numbers::pi))
    return broken("light_angle_rad", t.light_angle_rad, "0 (off) to pi, which is 180 degrees");
  return {};
}

std::string first_defect(const layers::KalmanNoise& noise) {
  const auto is_usable = [](double value) { return value >= 1e-12 && value <= 1e12; };
  const char* rule = "from 1e-12 to 1e12";
  if (!is_usable(noise.place_m)) return broken("kalman_place_m", noise.place_m, rule);
  if (!is_usable(noise.turn_rad)) return broken("kalman_turn_rad", noise.turn_rad, rule);
  if (!is_usable(noise.jerk_m)) return broken("kalman_jerk_m", noise.jerk_m, rule);
  if (!is_usable(noise.jerk_rad)) return broken("kalman_jerk_rad", noise.jerk_rad, rule);
  const auto lasts = [](double value_s) { return value_s == 0 || (value_s >= 1e-6 && value_s <= 1e6); };
  if (!lasts(noise.coast_s))
    return broken("kalman_coast_s", noise.coast_s, "0 (for ever), or from 1e-6 to 1e6");
  if (!lasts(noise.push_s)) return broken("kalman_push_s", noise.push_s, "0 (for ever), or from 1e-6 to 1e6");
  return {};
}

std::string first_defect(const BudgetOptions& b) {
  if (b.polygons < 0) return broken("budget_polygons", static_cast<double>(b.polygons), "at least 0");
  if (b.pixels < 0) return broken("budget_pixels", static_cast<double>(b.pixels), "at least 0");
  if (b.chunks < 0) return broken("budget_chunks", static_cast<double>(b.chunks), "at least 0");
  if (!(b.ms >= 0)) return broken("budget_ms", b.ms, "at least 0");
  if (!(b.min_resolution > 0 && b.min_resolution <= 1))
    return broken("min_resolution", b.min_resolution, "above 0 and at most 1");
  if (!(b.cutoff_px >= 0)) return broken("cutoff_px", b.cutoff_px, "at least 0");
  if (!(b.depth_complexity == 0 || (b.depth_complexity >= 1 && b.depth_complexity < HUGE_VAL)))
    return broken("depth_complexity", b.depth_complexity, "0 (measured) or at least 1");
  return {};
}

}  // namespace

std::string first_defect(const RegulatorOptions& options) {
  if (options.hold_frames < 1) return broken("hold_frames", options.hold_frames, "at least 1");
  if (options.blend_frames < 0) return broken("blend_frames", options.blend_frames, "at least 0 (0: off)");
  if (options.settle_frames < 0)
    return broken("settle_frames", options.settle_frames, "0 (off) or at least 1");
  if (std::string defect = first_defect(options.thresholds); !defect.empty()) return defect;
  if (options.lookahead.frames < 0) return broken("lookahead_frames", options.lookahead.frames, "at least 0");
  if (options.policy == Policy::Predictive) {
    if (std::string defect = first_defect(plan_shape(options)); !defect.empty()) return defect;
    if (options.predictive.intervals == Intervals::Data && options.lookahead.frames > kLongestCut_frames)
      return "lookahead is " + std::to_string(options.lookahead.frames) + ", must be at most " +
             std::to_string(kLongestCut_frames) + " where intervals is data";
  }
  if (std::string defect = first_defect(options.regroup); !defect.empty()) return defect;
  if (std::string defect = first_defect(options.lod); !defect.empty()) return defect;
  if (std::string defect = first_defect(options.latency); !defect.empty()) return defect;
  if (std::string defect = first_defect(options.kalman); !defect.empty()) return defect;
  return first_defect(options.budget);
}

PlanShape plan_shape(const RegulatorOptions& options) {
  return {options.lookahead.frames, options.predictive.children};
}

bool regroups(const RegulatorOptions& options) {
  return options.regroup.by == Regroup::Amortised && options.policy == Policy::Threshold;
}

bool refreshes_chunks(const RegulatorOptions& options) {
  return options.refresh == Refresh::Chunks && options.policy == Policy::Threshold &&
         options.thresholds.geometric_px > 0 && options.blend_frames == 0 && !regroups(options) &&
         !is_late(options.latency) && !chooses_levels(options);
}

bool chooses_levels(const RegulatorOptions& options) {
  switch (options.lod.by) {
    case LodSelector::None:
      return false;
    case LodSelector::Optimise:
      return options.policy == Policy::Budget;
    case LodSelector::Static:
    case LodSelector::Feedback:
      return options.policy == Policy::Reference || options.policy == Policy::Threshold ||
             options.policy == Policy::Budget;
  }
  return false;
}

bool asks_for_light(const RegulatorOptions& options) {
  return options.color_warp || options.thresholds.photometric != 0 || options.thresholds.light_angle_rad != 0;
}

bool follows_light(const RegulatorOptions& options) {
  if (!asks_for_light(options)) return false;
  switch (options.policy) {
    case Policy::Direct:
    case Policy::Reference:
    case Policy::Hold:
    case Policy::Predictive:
      return false;
    case Policy::Interpolate:
    case Policy::Threshold:
    case Policy::Budget:
    case Policy::Lookahead:
    case Policy::Oracle:
      return true;
  }
  return false;
}

double expected_reuse_frames(const RegulatorOptions& options, double threshold_default) {
  switch (options.policy) {
    case Policy::Direct:
    case Policy::Reference:
    case Policy::Hold:  // shown where it was: nothing new can come into view
    case Policy::Predictive:
      return 0;
    case Policy::Interpolate:
      return options.hold_frames - 1;
    case Policy::Threshold:
    case Policy::Lookahead:
    case Policy::Oracle:
      return options.thresholds.geometric_px > 0 ? threshold_default : 0;
    case Policy::Budget:
      return threshold_default;
  }
  return 0;
}

}  // namespace talisman::regulator
