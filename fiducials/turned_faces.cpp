// SPDX-License-Identifier: Apache-2.0
#include "fiducials/turned_faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "layers/clip.h"

namespace talisman::fiducials {
namespace {

using layers::dvec4;
using layers::LayerState;
using layers::Polyhedron;

TurnedFaces no_turned_faces(std::string_view why) {
  TurnedFaces t;
  t.why_not = why;
  return t;
}

/// The s of each face; 0, which faces nobody, for a face without area.
std::vector<double> facing(const LayerState& state, const Polyhedron& hull) {
  const std::vector<dvec3> areas = layers::face_areas(state.world_points, hull, state.world_from_body);
  double largest = 0;
  for (const dvec3& area : areas) largest = std::max(largest, glm::length(area));
  std::vector<double> result;
  result.reserve(areas.size());
  for (std::size_t face = 0; face < areas.size(); ++face) {
    const int first = face == 0 ? 0 : hull.face_ends[face - 1];
    const dvec3 to_eye = state.eye() - state.world_points[hull.triangles[first][0]];
    const double area = glm::length(areas[face]), distance = glm::length(to_eye);
    const bool is_face = area > kEdgeOn * largest && distance > 0;
    result.push_back(is_face ? dot(areas[face], to_eye) / area / distance : 0);
  }
  return result;
}

/// The corners of a face, in order, in clip space.
std::vector<dvec4> corners_of(const LayerState& state, const Polyhedron& hull, std::size_t face) {
  const int first = face == 0 ? 0 : hull.face_ends[face - 1];
  std::vector<dvec4> corners = {state.clip_points[hull.triangles[first][0]],
                                state.clip_points[hull.triangles[first][1]]};
  for (int t = first; t < hull.face_ends[face]; ++t)
    corners.push_back(state.clip_points[hull.triangles[t][2]]);
  return corners;
}

/// Sutherland & Hodgman, in clip space.
std::vector<dvec4> clipped(std::vector<dvec4> polygon, const layers::HalfSpace& half_space) {
  std::vector<dvec4> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = half_space.distance(a), db = half_space.distance(b);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

/// The part of a face that is on the display.
struct Shown {
  double area_px2 = 0;
  dvec2 middle_px{0, 0};
};

Shown shown_part(const LayerState& state, std::vector<dvec4> polygon) {
  for (const layers::HalfSpace& h : layers::view_half_spaces(state.camera.near_m, 0, 0))
    polygon = clipped(std::move(polygon), h);
  std::vector<dvec2> corners;
  corners.reserve(polygon.size());
  for (const dvec4& clip : polygon) corners.push_back(layers::screen_from_clip(clip, state.view.display_px));
  Shown shown;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const dvec2 u = corners[i] - corners[0], v = corners[i + 1] - corners[0];
    shown.area_px2 += (u.x * v.y - u.y * v.x) / 2;
  }
  for (const dvec2& corner : corners) shown.middle_px += corner / static_cast<double>(corners.size());
  shown.area_px2 = std::isfinite(shown.area_px2) ? std::fabs(shown.area_px2) : 0;
  return shown;
}

}  // namespace

TurnedFaces turned_faces_of(const LayerState& then, const LayerState& now, const Polyhedron& hull) {
  if (then.world_from_body.empty() || now.world_from_body.empty()) return no_turned_faces("not asked for");
  if (now.world_points.empty() || then.world_points.size() != now.world_points.size())
    return no_turned_faces("the layer has no characteristic points");
  TurnedFaces turned;
  turned.computed = true;
  const std::vector<double> before = facing(then, hull), after = facing(now, hull);
  for (std::size_t face = 0; face < after.size(); ++face) {
    if (!(before[face] <= kEdgeOn && after[face] > kEdgeOn)) continue;
    ++turned.count;
    const Shown shown = shown_part(now, corners_of(now, hull, face));
    const double px = std::sqrt(shown.area_px2);
    if (px > turned.px) turned.px = px, turned.where_px = shown.middle_px;
  }
  return turned;
}

}  // namespace talisman::fiducials
