// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which material points of a polyhedron's surface are in view, in one state or in two?
///
/// A material point of the surface is carried by its clip coordinates in two states. Clip coordinates are
/// linear in the barycentric coordinates of a triangle, so a point that a plane cuts out of an edge in one
/// state is the same material point in the other state when both are interpolated with the same factor
/// [LS97 3.1, Fig. 13].
///
/// A view is five half-spaces in clip space, g = 1 + 2 · clip_margin (a margin is a share of the display,
/// whose sides are 2 wide in x / w and y / w):
///
///   g w + x ≥ 0,  g w - x ≥ 0,  g w + y ≥ 0,  g w - y ≥ 0,  w > near
///
/// The far plane takes no part: what is too far away to be drawn has still a well-defined place on the
/// display.

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::layers {

/// distance = x · clip.x + y · clip.y + w · clip.w + constant, of clip coordinates in state 0 or 1; ≥ 0 is
/// inside.
struct HalfSpace {
  int state = 0;
  double x = 0, y = 0, w = 0, constant = 0;
  double distance(const dvec4& clip) const { return x * clip.x + y * clip.y + w * clip.w + constant; }
};

inline constexpr int kViewHalfSpaces = 5;
using ViewHalfSpaces = std::array<HalfSpace, kViewHalfSpaces>;

/// Points this close outside a half-space, relative to w (about 1e-6 px), count as on its plane: what was cut
/// by a plane in one state is not cut again by the same plane in the other.
inline constexpr double kOnPlane = 1e-9;

/// The half-spaces of a view, the near plane first. Points inside have w > near strictly. `near_m` > 0,
/// `clip_margin` ≥ 0, along x and y.
ViewHalfSpaces view_half_spaces(double near_m, dvec2 clip_margin, int state);
inline ViewHalfSpaces view_half_spaces(double near_m, double clip_margin, int state) {
  return view_half_spaces(near_m, dvec2(clip_margin), state);
}

/// Bit i is set where the point is outside half-space i (also where it is not a number).
unsigned outcode(const ViewHalfSpaces& view, const dvec4& clip);

struct MaterialPoint {
  std::array<dvec4, 2> clip;  ///< in state 0 and 1
  int point = -1;             ///< index of the vertex of the polyhedron, or -1 for a point made by clipping
};

/// Of the largest coordinate: two ways to one place differ by less.
inline constexpr double kRoundingOfCrossings = 1e-10;

/// The same place but for the rounding of two ways to it. A flat polyhedron has edges that coincide, and the
/// point at which one leaves the view, if it counted as often as its roundings differ, would weigh more in a
/// fit. Most places differ in the first coordinate already.
bool is_same_in_all_coordinates(const MaterialPoint& a, const MaterialPoint& b);
inline bool is_same_place(const MaterialPoint& a, const MaterialPoint& b) {
  const dvec4& p = a.clip[0];
  const double at_least_size = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) + std::fabs(p.w);
  if (std::fabs(p.x - b.clip[0].x) > kRoundingOfCrossings * at_least_size) return false;
  return is_same_in_all_coordinates(a, b);
}

/// Calls `visit` with what the half-spaces leave of each triangle, a convex polygon, in the order of the
/// triangles; not where nothing is left. At most 32 half-spaces. Cost: O(triangles · half-spaces) for triangles
/// that cross a plane, O(1) for the others.
void clip_polygons(std::span<const std::array<int, 3>> triangles, std::span<const dvec4> clip_0,
                   std::span<const dvec4> clip_1, std::span<const HalfSpace> half_spaces,
                   const std::function<void(std::span<const MaterialPoint>)>& visit);

/// The vertices of the polyhedron's surface clipped to all `half_spaces`: original vertices inside, crossings
/// of edges, and places where an edge of the view pierces a triangle. Each once, in the order of the
/// triangles. `clip_0` and `clip_1` are the vertices of the polyhedron in the two states (equal sizes). Cost: as
/// clip_polygons.
std::vector<MaterialPoint> clip_surface(std::span<const std::array<int, 3>> triangles,
                                        std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
                                        std::span<const HalfSpace> half_spaces);

/// Polygons one behind the other: the first has the corners up to ends[0], the next those up to ends[1] …
struct PolygonList {
  std::vector<MaterialPoint> corners;
  std::vector<std::size_t> ends;

  void reserve(std::size_t polygons);
  void push(std::span<const MaterialPoint> polygon);
  std::size_t size() const { return ends.size(); }
  std::span<const MaterialPoint> operator[](std::size_t i) const;
};

/// The same vertices, and the polygons to which they belong, appended to `polygons`.
std::vector<MaterialPoint> clip_surface(std::span<const std::array<int, 3>> triangles,
                                        std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
                                        std::span<const HalfSpace> half_spaces, PolygonList& polygons);

}  // namespace talisman::layers
