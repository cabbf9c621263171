// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "layers/check.h"
#include "layers/clip.h"
#include "layers/state.h"

namespace talisman::layers {
namespace {

ViewHalfSpaces half_spaces_of(const LayerState& state, int index) {
  return view_half_spaces(state.camera.near_m, state.view.clip_margin, index);
}

bool is_wholly_in_view(const LayerState& state) { return state.in_view() && !state.clipped; }

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

/// Where nothing is clipped every point has its place on the display already.
void match_characteristic_points(const LayerState& then, const LayerState& now, Correspondences& matched) {
  reserve(then.screen_points.size(), matched);
  for (std::size_t i = 0; i < then.screen_points.size(); ++i)
    add(then.screen_points[i], now.screen_points[i], static_cast<int>(i), matched);
}

void match_all(const std::vector<MaterialPoint>& points, const LayerState& then, const LayerState& now,
               Correspondences& matched) {
  reserve(points.size(), matched);
  for (const MaterialPoint& p : points) match(p.clip[0], p.clip[1], p.point, then, now, matched);
}

std::vector<MaterialPoint> in_both_views(const LayerState& then, const LayerState& now,
                                         const Polyhedron& hull) {
  std::array<HalfSpace, 2 * kViewHalfSpaces> half_spaces;
  const auto of_then = half_spaces_of(then, 0), of_now = half_spaces_of(now, 1);
  for (int i = 0; i < kViewHalfSpaces; ++i) {  // both near planes first: beyond them nothing is huge
    half_spaces[2 * i] = of_then[i];
    half_spaces[2 * i + 1] = of_now[i];
  }
  return clip_surface(hull.triangles, then.clip_points, now.clip_points, half_spaces);
}

std::vector<MaterialPoint> in_either_view(const LayerState& then, const LayerState& now,
                                          const Polyhedron& hull) {
  auto points = clip_surface(hull.triangles, then.clip_points, now.clip_points, half_spaces_of(then, 0));
  // No point is in both views, so there is nothing to merge.
  const auto more = clip_surface(hull.triangles, then.clip_points, now.clip_points, half_spaces_of(now, 1));
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

}  // namespace

Correspondences correspond(const LayerState& then, const LayerState& now, const Polyhedron& hull) {
  Correspondences matched;
  if (then.clip_points.empty() || now.clip_points.empty()) return matched;
  TALISMAN_CHECK_EQ(then.clip_points.size(), now.clip_points.size());
  if (is_wholly_in_view(then) && is_wholly_in_view(now)) {
    match_characteristic_points(then, now, matched);
    matched.overlap = !matched.point.empty();
    return matched;
  }
  match_all(in_both_views(then, now, hull), then, now, matched);
  matched.overlap = !matched.point.empty();
  if (!matched.overlap) match_all(in_either_view(then, now, hull), then, now, matched);
  return matched;
}

}  // namespace talisman::layers
