// SPDX-License-Identifier: Apache-2.0
#include "fiducials/cut_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "layers/outline.h"

namespace talisman::fiducials {
namespace {

using layers::LayerState;
using layers::RectD;
using layers::SpritePlacement;
using warp::Warp;

/// Less than this is rounding: the side has not moved in.
constexpr double kRoundingPx = 1e-6;

struct Side {
  dvec2 from, to;
  dvec2 inside;  ///< the opposite side's middle: tells which half-plane is the outer one
};

/// The cut sides as segments on the display at the instant of rendering.
layers::InlineVector<Side, 4> cut_sides(const SpritePlacement& placement) {
  const double w = placement.size_px.x, h = placement.size_px.y;
  const layers::Affine2& screen = placement.screen_from_sprite;
  layers::InlineVector<Side, 4> sides;
  const auto add = [&](bool cut, dvec2 from, dvec2 to, dvec2 inside) {
    if (cut) sides.push_back({screen(from), screen(to), screen(inside)});
  };
  add(placement.clipped.left, {0, 0}, {0, h}, {w, h / 2});
  add(placement.clipped.right, {w, 0}, {w, h}, {0, h / 2});
  add(placement.clipped.top, {0, 0}, {w, 0}, {w / 2, h});
  add(placement.clipped.bottom, {0, h}, {w, h}, {w / 2, 0});
  return sides;
}

/// The part of the display that the layer may cover.
struct Visible {
  layers::Polygon2 outline;
  RectD bounds;
  dvec2 centre() const { return (bounds.lo + bounds.hi) / 2.0; }
};

Visible visible_part(const LayerState& state) {
  const RectD display{{0, 0}, dvec2(state.view.display_px)};
  Visible visible{layers::clip_to_rect(layers::convex_hull(state.screen_points), display), {}};
  for (const dvec2& p : visible.outline) visible.bounds.include(p);
  return visible;
}

struct Depth {
  double px = 0;
  dvec2 where_px{0, 0};
};

Depth depth_beyond(const Side& side, const Visible& visible) {
  const dvec2 centre = visible.centre();
  const double length = glm::length(side.to - side.from);
  if (visible.outline.empty() || !(length > 0)) return {0, centre};
  const dvec2 along = (side.to - side.from) / length;
  dvec2 outward{-along.y, along.x};
  if (glm::dot(outward, side.inside - side.from) > 0) outward = -outward;
  layers::Polygon2 uncovered =
      layers::clip_to_half_plane(visible.outline, outward, glm::dot(outward, side.from));
  uncovered = layers::clip_to_half_plane(uncovered, along, glm::dot(along, side.from));
  uncovered = layers::clip_to_half_plane(uncovered, -along, -glm::dot(along, side.to));
  Depth deepest{0, centre};
  for (const dvec2& p : uncovered) {
    const double px = glm::dot(outward, p - side.from);
    if (px > deepest.px) deepest = {px, p};
  }
  return deepest;
}

/// Beyond the horizon of a perspective warp nothing is known: all that is visible counts as uncovered.
Depth depth_now(const Side& side, const Warp& warp, const Visible& visible) {
  for (const dvec2& p : {side.from, side.to, side.inside})
    if (!(warp.denominator(p) > 0))
      return {glm::length(visible.bounds.hi - visible.bounds.lo), visible.centre()};
  return depth_beyond({warp(side.from), warp(side.to), warp(side.inside)}, visible);
}

Visibility no_cut_sides(std::string_view why) {
  Visibility v;
  v.why_not = why;
  return v;
}

}  // namespace

Visibility visibility_of(const LayerState& then, const LayerState& now, const SpritePlacement& placement,
                         const Warp& warp) {
  if (placement.empty()) return no_cut_sides("nothing was drawn");
  if (!placement.clipped.any()) return no_cut_sides("no side of the sprite was cut off");
  const Visible visible_now = visible_part(now);
  std::optional<Visible> visible_then;  // asked for only where something is beyond a side now
  if (visible_now.outline.empty()) return no_cut_sides("the layer is out of view");
  Visibility result;
  result.computed = true;
  result.where_px = visible_now.centre();
  for (const Side& side : cut_sides(placement)) {
    const Depth deepest = depth_now(side, warp, visible_now);
    const double most = std::fmax(result.uncovered_px, kRoundingPx);
    if (deepest.px <= most) continue;
    if (!visible_then) visible_then = visible_part(then);
    const double gained = deepest.px - depth_beyond(side, *visible_then).px;
    if (gained > most) {
      result.uncovered_px = gained;
      result.where_px = deepest.where_px;
    }
  }
  return result;
}

}  // namespace talisman::fiducials
