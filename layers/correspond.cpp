// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "layers/check.h"
#include "layers/clip.h"
#include "layers/foreshortening.h"
#include "layers/state.h"

namespace talisman::layers {
namespace {

/// The two views of one correspondence.
struct Views {
  ViewHalfSpaces then, now;
};

/// The place of a characteristic point on the display: as it was captured, where nothing was cut off.
dvec2 place_of(const LayerState& state, std::size_t point) {
  const bool is_captured = state.in_view() && !state.clipped;
  return is_captured ? state.screen_points[point]
                     : screen_from_clip(state.clip_points[point], state.view.display_px);
}

/// The fastest motion per frame of the characteristic points that are on the display now, as far as that is a
/// small part of the display.
double motion_in_one_frame(const LayerState& then, const LayerState& now, int frames) {
  constexpr double kMost = 0.25;  // of the display
  const dvec2 size(now.view.display_px);
  const auto display = view_half_spaces(now.camera.near_m, 0.0, 0);
  double fastest = 0;
  for (std::size_t i = 0; i < now.clip_points.size(); ++i) {
    if (outcode(display, now.clip_points[i]) != 0 || !(then.clip_points[i].w > then.camera.near_m)) continue;
    const dvec2 path = place_of(now, i) - place_of(then, i);
    fastest = std::max(fastest, std::hypot(path.x, path.y));
  }
  return std::min(fastest / std::max(frames, 1), kMost * std::max(size.x, size.y));
}

Views views_of(const LayerState& then, const LayerState& now, int frames) {
  constexpr double kLeast_px = 1;
  const dvec2 size(now.view.display_px);
  const dvec2 margin_px(std::max(kLeast_px, motion_in_one_frame(then, now, frames)));
  const double then_margin = std::max(kThenMargin, then.view.clip_margin);
  return {view_half_spaces(then.camera.near_m, then_margin, 0),
          view_half_spaces(now.camera.near_m, margin_px / size, 1)};
}

/// Nothing is cut off: all characteristic points are on the grown display, and were not far from it.
bool is_wholly_in_view(const LayerState& then, const LayerState& now, const Views& views) {
  const auto inside = [](const ViewHalfSpaces& view, const std::vector<dvec4>& points) {
    return std::all_of(points.begin(), points.end(), [&](const dvec4& p) { return outcode(view, p) == 0; });
  };
  const auto is_unclipped = [](const LayerState& state) { return state.in_view() && !state.clipped; };
  if (!is_unclipped(now) || !inside(views.now, now.clip_points)) return false;
  return (is_unclipped(then) && then.view.clip_margin <= kThenMargin) || inside(views.then, then.clip_points);
}

void add(dvec2 then_px, dvec2 now_px, int point, Correspondences& matched) {
  if (!(std::isfinite(then_px.x + then_px.y) && std::isfinite(now_px.x + now_px.y))) return;
  matched.then_px.push_back(then_px);
  matched.now_px.push_back(now_px);
  matched.point.push_back(point);
}

/// Adds a material point if it has a place on both displays.
void match(const dvec4& clip_then, const dvec4& clip_now, int point, const LayerState& then,
           const LayerState& now, Correspondences& matched) {
  if (!(clip_then.w > then.camera.near_m && clip_now.w > now.camera.near_m)) return;
  add(screen_from_clip(clip_then, then.view.display_px), screen_from_clip(clip_now, now.view.display_px),
      point, matched);
}

void reserve(std::size_t count, Correspondences& matched) {
  matched.then_px.reserve(count);
  matched.now_px.reserve(count);
  matched.point.reserve(count);
}

void match_characteristic_points(const LayerState& then, const LayerState& now, Correspondences& matched) {
  reserve(now.clip_points.size(), matched);
  for (std::size_t i = 0; i < now.clip_points.size(); ++i)
    if (then.clip_points[i].w > then.camera.near_m && now.clip_points[i].w > now.camera.near_m)
      add(place_of(then, i), place_of(now, i), static_cast<int>(i), matched);
}

void match_all(const std::vector<MaterialPoint>& points, const LayerState& then, const LayerState& now,
               Correspondences& matched) {
  reserve(points.size(), matched);
  for (const MaterialPoint& p : points) match(p.clip[0], p.clip[1], p.point, then, now, matched);
}

/// The material points of what deforms, as far as they are in both views.
void match_material_points(const LayerState& then, const LayerState& now, const Views& views,
                           Correspondences& matched) {
  if (then.material_clip.size() != now.material_clip.size()) return;  // one state was not finite
  for (std::size_t i = 0; i < now.material_clip.size(); ++i)
    if (outcode(views.then, then.material_clip[i]) == 0 && outcode(views.now, now.material_clip[i]) == 0)
      match(then.material_clip[i], now.material_clip[i], static_cast<int>(now.world_points.size() + i), then,
            now, matched);
}

using BothViews = std::array<HalfSpace, 2 * kViewHalfSpaces>;

BothViews both_views(const Views& views) {
  BothViews half_spaces;
  for (int i = 0; i < kViewHalfSpaces; ++i) {  // both near planes first: beyond them nothing is huge
    half_spaces[2 * i] = views.then[i];
    half_spaces[2 * i + 1] = views.now[i];
  }
  return half_spaces;
}

double diagonal_px(std::span<const dvec2> points) {
  RectD bounds;
  for (const dvec2& p : points) bounds.include(p);
  return bounds.empty() ? 0 : std::hypot(bounds.hi.x - bounds.lo.x, bounds.hi.y - bounds.lo.y);
}

/// How the depths of the corners have changed, now over then.
struct DepthRatios {
  double least = HUGE_VAL, most = 0;
  void include(const dvec4& clip_then, const dvec4& clip_now) {
    const double ratio = clip_now.w / clip_then.w;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
};

bool any_bow(const DepthRatios& ratios, const Correspondences& matched) {
  return can_bow(ratios.least, ratios.most, diagonal_px(matched.now_px));
}

/// Places between the corners that the corners' motion does not explain (layers/foreshortening.h).
void match_bowed_places(const LayerState& then, const LayerState& now, const PolygonList& surface,
                        Correspondences& matched) {
  match_all(bowed_places(surface, now.view.display_px), then, now, matched);
}

PolygonList whole_surface(const LayerState& then, const LayerState& now, const Polyhedron& hull) {
  PolygonList polygons;
  polygons.reserve(hull.triangles.size());
  for (const auto& triangle : hull.triangles) {
    std::array<MaterialPoint, 3> corners;
    for (int k = 0; k < 3; ++k) {
      const int i = triangle[k];
      corners[k] = {{then.clip_points[i], now.clip_points[i]}, i};
    }
    polygons.push(corners);
  }
  return polygons;
}

void match_whole_surface(const LayerState& then, const LayerState& now, const Polyhedron& hull,
                         Correspondences& matched) {
  match_characteristic_points(then, now, matched);
  DepthRatios ratios;
  for (std::size_t i = 0; i < now.clip_points.size(); ++i)
    ratios.include(then.clip_points[i], now.clip_points[i]);
  if (any_bow(ratios, matched)) match_bowed_places(then, now, whole_surface(then, now, hull), matched);
}

void match_clipped_surface(const LayerState& then, const LayerState& now, const Polyhedron& hull,
                           const BothViews& half_spaces, Correspondences& matched) {
  PolygonList surface;
  const auto points = clip_surface(hull.triangles, then.clip_points, now.clip_points, half_spaces, surface);
  match_all(points, then, now, matched);
  DepthRatios ratios;
  for (const MaterialPoint& p : points) ratios.include(p.clip[0], p.clip[1]);
  if (any_bow(ratios, matched)) match_bowed_places(then, now, surface, matched);
}

std::vector<MaterialPoint> in_either_view(const LayerState& then, const LayerState& now, const Views& views,
                                          const Polyhedron& hull) {
  auto points = clip_surface(hull.triangles, then.clip_points, now.clip_points, views.then);
  // No point is in both views, so there is nothing to merge.
  const auto more = clip_surface(hull.triangles, then.clip_points, now.clip_points, views.now);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

}  // namespace

Correspondences correspond(const LayerState& then, const LayerState& now, const Polyhedron& hull,
                           int frames) {
  Correspondences matched;
  if (then.clip_points.empty() || now.clip_points.empty()) return matched;
  TALISMAN_CHECK_EQ(then.clip_points.size(), now.clip_points.size());
  const Views views = views_of(then, now, frames);
  if (is_wholly_in_view(then, now, views))
    match_whole_surface(then, now, hull, matched);
  else
    match_clipped_surface(then, now, hull, both_views(views), matched);
  matched.overlap = !matched.point.empty();
  if (!matched.overlap) match_all(in_either_view(then, now, views, hull), then, now, matched);
  match_material_points(then, now, views, matched);
  return matched;
}

}  // namespace talisman::layers
