// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fiducials/cut_sides.h"
#include "fiducials/fiducials.h"
#include "fiducials/shade_drift.h"

namespace talisman::fiducials {
namespace {

using layers::Correspondences;
using layers::LayerState;
using layers::RectD;
using layers::SpritePlacement;

/// Where nothing could be matched but the layer is in view, nothing is known of where the picture went.
Geometric unknown_place(const LayerState& now) {
  if (!now.touches_display) return {};
  return {warp::kHugePx, (now.screen_bounds_px.lo + now.screen_bounds_px.hi) / 2.0, -1};
}

Geometric geometric_of(const LayerState& now, const Correspondences& matched, const warp::FitResult& fitted) {
  if (matched.then_px.empty()) return unknown_place(now);
  if (!fitted.usable()) return {warp::kHugePx, {0, 0}, fitted.worst_point};
  warp::FitResult measured = fitted;
  warp::measure(matched.then_px, matched.now_px, measured);
  return {measured.max_px, matched.now_px[measured.worst_point], measured.worst_point};
}

/// The bounding box of what is shown now on the display at the instant of rendering: the same however far the
/// sprite reaches.
RectD shown_rect(const Correspondences& matched) {
  RectD bounds;
  for (const dvec2& p : matched.then_px) bounds.include(p);
  return bounds;
}

/// The bounding box of the sprite on the display at the instant of rendering.
RectD display_rect(const SpritePlacement& placement) {
  RectD bounds;
  if (placement.empty()) return bounds;
  const double w = placement.size_px.x, h = placement.size_px.y;
  for (const dvec2& corner : {dvec2{0, 0}, dvec2{w, 0}, dvec2{w, h}, dvec2{0, h}})
    bounds.include(placement.screen_from_sprite(corner));
  return bounds;
}

}  // namespace

Report assess(const LayerState& then, const LayerState& now, const SpritePlacement& placement,
              const Correspondences& matched, const warp::FitResult& fitted) {
  Report report{geometric_of(now, matched, fitted),
                sampling_over(fitted.warp, matched.overlap ? shown_rect(matched) : display_rect(placement)),
                visibility_of(then, now, placement, fitted.warp)};
  report.shade = shade_motion(then, now);
  if (report.shade.px > report.geometric.px) report.geometric.where_px = report.shade.where_px;
  report.geometric.px = std::fmin(report.geometric.px + report.shade.px, warp::kHugePx);
  return report;
}

}  // namespace talisman::fiducials
