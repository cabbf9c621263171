// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "regulator/decision.h"
#include "regulator/policies.h"
#include "regulator/resolution.h"
#include "regulator/settle.h"

namespace talisman::regulator {

namespace {

std::string name_of(const fiducials::LightRef& light) {
  if (light.index == fiducials::LightRef::kEye) return " (highlights: the eye)";
  if (light.index < 0) return {};
  return light.name.empty() ? " (light " + std::to_string(light.index) + ")"
                            : " (light '" + std::string(light.name) + "')";
}

std::string photometric_violation(const fiducials::Photometric& p, const Thresholds& limits) {
  if (!p.computed) return {};
  if (limits.photometric > 0 && !(p.color <= limits.photometric))
    return comparison("photometric", p.color, ">", limits.photometric) + name_of(p.color_light);
  if (limits.light_angle_rad > 0 && !(p.light_angle_rad <= limits.light_angle_rad))
    return comparison("photometric: light angle", p.light_angle_rad, ">", limits.light_angle_rad, "rad") +
           name_of(p.angle_light);
  return {};
}

/// " (0.761 of place + 6.012 of the shadow of 'rotor' in light 'key')"; empty where nothing ran over the layer.
std::string share_of_shade(const fiducials::Report& report) {
  if (!(report.shade.px > 0)) return {};
  constexpr double kShown_px = 0.0005;  // what three decimals show
  const double place = report.geometric.px - report.shade.px;
  const std::string what = report.shade.what.empty() ? "what ran over it" : report.shade.what;
  char numbers[80];
  if (place < kShown_px)
    numbers[0] = '\0';
  else
    std::snprintf(numbers, sizeof numbers, "%.3f of place + %.3f ", place, report.shade.px);
  return std::string(" (") + numbers + "of " + what + ")";
}

/// Displacement of a layer counts by its weight: twice as important is half as far off. Weight 0: no limit.
double geometric_limit_px(const LayerAssessment& layer, const Thresholds& limits) {
  return limits.geometric_px / layer.preferences.importance.geometric;
}

/// The first fiducial beyond its threshold, in words and numbers, or an empty string.
/// The order is that of [LS97 5]: geometry first, because it is the one that users set.
std::string first_violation(const LayerAssessment& layer, const Thresholds& limits) {
  const fiducials::Report& f = layer.fiducials;
  if (!layer.fitted.usable()) return "fit: " + std::string(warp::name(layer.fitted.status));
  if (layer.matched_points < kFewestMatchedPoints)
    return comparison("matched points", layer.matched_points, "<", kFewestMatchedPoints);
  if (const double most_px = geometric_limit_px(layer, limits); !(f.geometric.px <= most_px))
    return comparison("geometric", f.geometric.px, ">", most_px, "px") + share_of_shade(f);
  if (std::string light = photometric_violation(f.photometric, limits); !light.empty()) return light;
  if (limits.magnification > 0 && !(f.sampling.magnification <= limits.magnification))
    return comparison("sampling: magnification", f.sampling.magnification, ">", limits.magnification);
  if (limits.minification > 0 && !(f.sampling.minification >= limits.minification))
    return comparison("sampling: minification", f.sampling.minification, "<", limits.minification);
  if (limits.anisotropy > 0 && !(f.sampling.anisotropy <= limits.anisotropy))
    return comparison("sampling: anisotropy", f.sampling.anisotropy, ">", limits.anisotropy);
  if (limits.uncovered_px >= 0 && f.visibility.computed &&
      !(f.visibility.uncovered_px <= limits.uncovered_px))
    return comparison("visibility: uncovered edge", f.visibility.uncovered_px, ">", limits.uncovered_px,
                      "px");
  if (limits.turned_px > 0 && f.turned.computed && !(f.turned.px <= limits.turned_px))
    return comparison("visibility: side turned to the eye", f.turned.px, ">", limits.turned_px, "px");
  return {};
}

}  // namespace

bool due_by_minimum_rate(const LayerAssessment& layer) {
  const double rate = layer.preferences.min_update_rate;
  return rate > 0 && layer.frames_since_render * rate >= 1;
}

bool barred_by_maximum_rate(const LayerAssessment& layer) {
  return layer.frames_since_render * layer.preferences.max_update_rate < 1;
}

bool has_sound_fit(const LayerAssessment& layer) {
  return layer.fitted.usable() && layer.matched_points >= kFewestMatchedPoints;
}

bool may_fade_out(const LayerAssessment& old, const RegulatorOptions& options) {
  if (!(options.thresholds.geometric_px > 0) || !old.new_picture.empty()) return false;
  if (old.identical) return true;
  Thresholds limits = options.thresholds;
  limits.geometric_px *= kMostFadedError;
  limits.photometric *= kMostFadedError;
  limits.light_angle_rad *= kMostFadedError;
  limits.magnification = limits.minification = limits.anisotropy = limits.turned_px =
      0;  // of how sharp it is
  return first_violation(old, limits).empty();
}

std::string violation_of(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (nothing_to_gain(layer)) return {};
  if (!layer.new_picture.empty()) return layer.new_picture;  // within no bound, however small
  if (!(options.thresholds.geometric_px > 0)) return "changed, geometric threshold 0 px";
  std::string violation = first_violation(layer, options.thresholds);
  if (violation.empty() && due_by_minimum_rate(layer))
    violation = comparison("min_update_rate: frames since render", layer.frames_since_render,
                           ">=", 1 / layer.preferences.min_update_rate);
  return violation;
}

namespace {

/// "12 of 80 chunks"
std::string in_words(const ChunkShare& share) {
  return std::to_string(share.drawn) + " of " + std::to_string(share.stored) + " chunks";
}

/// What is known of the layer if its chunks over the bound are drawn.
LayerAssessment with_chunks_drawn(const LayerAssessment& layer) {
  LayerAssessment drawn = layer;
  drawn.fitted = layer.chunks->fitted;
  drawn.fiducials = layer.chunks->fiducials;
  return drawn;
}

/// A sprite that does not serve as a whole, or whose chunks are of several instants: the chunks over the bound are drawn
/// where that is all that is wrong with it, none where none is over, else the whole.
LayerDecision decide_chunks(const LayerAssessment& layer, const RegulatorOptions& options) {
  const ChunkAssessment& chunks = *layer.chunks;
  const LayerAssessment drawn = chunks.why_whole.empty() ? with_chunks_drawn(layer) : layer;
  const std::string why_whole = chunks.why_whole.empty() ? violation_of(drawn, options) : chunks.why_whole;
  if (!why_whole.empty() || settles(drawn, options)) {
    std::string reason = violation_of(layer, options);
    if (reason.empty()) reason = why_whole.empty() ? settle_reason(drawn) : "chunks of several instants";
    return rerender(layer,
                    reason + (why_whole.empty() || why_whole == reason ? "" : "; whole: " + why_whole));
  }
  const double limit_px = geometric_limit_px(layer, options.thresholds);
  LayerDecision decision =
      reuse(drawn, comparison("geometric", drawn.fiducials.geometric.px, "<=", limit_px, "px"));
  decision.chunks = chunks.share;
  if (chunks.share.drawn == 0) return decision;
  decision.action = Action::Refresh;
  decision.reason = comparison("geometric", layer.fiducials.geometric.px, ">", limit_px, "px") + " in " +
                    in_words(chunks.share);
  decision.warp_geometric_px = layer.fiducials.geometric.px;
  decision.cost = chunks.cost;
  return decision;
}

}  // namespace

/// Renders a layer again when a fiducial says that its warped sprite is no longer good enough: the threshold
/// regulator of [LS97 6]. A threshold of 0 px reuses only what would be drawn identically, so that the
/// pictures equal `reference`.
LayerDecision decide_threshold(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (nothing_to_gain(layer)) return reuse(layer, "unchanged");
  if (layer.chunks && !barred_by_maximum_rate(layer)) return decide_chunks(layer, options);
  std::string violation = violation_of(layer, options);
  const bool settled = violation.empty() && settles(layer, options);
  if (settled) violation = settle_reason(layer);
  if (violation.empty())
    return reuse(layer, comparison("geometric", layer.fiducials.geometric.px,
                                   "<=", geometric_limit_px(layer, options.thresholds), "px"));
  if (has_sound_fit(layer) && barred_by_maximum_rate(layer))
    return reuse(layer, "deferred: max_update_rate; " + violation);
  LayerDecision decision = rerender(layer, std::move(violation));
  decision.settled = settled;
  return decision;
}

}  // namespace talisman::regulator
