// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which few points stand for the motion of a whole layer? Characteristic bounding polyhedra [LS97 3.1].
///
/// The motion of a layer is tracked by a small convex polyhedron around its geometry. Its vertices are the
/// characteristic points. For a rigid layer they are fixed in the space of the node that carries it; for a
/// layer whose parts deform or move against each other they are recomputed at each time, with the same
/// indices (point i always is the same corner of the same set of planes), so that point i then and point i
/// now can be matched.
///
/// All kinds are one construction: a box with its corners and edges cut. With u the distances (metres, ≥ 0)
/// of a point from the three box planes that meet in corner s, the cuts are the supports over the points
///
///   k(s)    = min (u_a + u_b + u_c)      how deep corner s can be cut
///   e(s,c)  = min (u_a + u_b)            how deep the edge through s along axis c can be cut
///
/// and the vertex of face a, edge (a, b) and corner s lies at u_a = 0, u_b = e(s,c), u_c = k(s) - e(s,c). The
/// cuts are then made shallower, never deeper, until no two of them cross, so that the topology holds for
/// every point set:
///
///   k(s) + k(s') - 2 e(s,c) ≤ length of axis c   for the corners s, s' at the ends of every edge, and
///   e(s,b) + e(s,c) ≤ k(s)                       for every two edges at a corner.

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "layers/layer.h"
#include "layers/point_shading.h"
#include "layers/surface_samples.h"

namespace talisman::layers {

/// Which planes bound the layer. Box8: 6 planes, 8 points, 12 triangles. Dop14: box with its corners cut, 14
/// planes, 24 points, 44 triangles. Dop26: corners and edges cut, 26 planes, 48 points, 92 triangles. More
/// planes follow the shape more tightly and cost time in every fit. Plane normals are (±1, 0, 0), (±1, ±1,
/// ±1), (±1, ±1, 0) and permutations.
enum class BoundKind { Box8, Dop14, Dop26 };

/// A closed convex polyhedron with fixed topology per kind (degenerate edges and faces are allowed).
struct Polyhedron {
  std::vector<dvec3> points;
  /// Fan triangulation of the faces, counter-clockwise from outside.
  std::vector<std::array<int, 3>> triangles;
  /// Face k is the fan of the triangles from face_ends[k - 1] (0 for the first) up to face_ends[k].
  std::vector<int> face_ends{};
};

/// The bounding polyhedron of a point set: contains every point (to rounding, 1e-9 of the extent). An empty
/// or non-finite set gives no points and no triangles. Cost: O(points · planes).
Polyhedron bounding_polyhedron(std::span<const dvec3> points, BoundKind kind);

/// The triangles that all polyhedra of a kind share.
std::span<const std::array<int, 3>> topology(BoundKind kind);
/// Likewise the ends of their faces.
std::span<const int> face_ends(BoundKind kind);

/// Twice the area of each face times its outer normal, in the world. The faces are those of as many bodies as
/// there are matrices, in this order; a body whose matrix mirrors has its triangles clockwise in the world.
/// Cost: O(triangles).
std::vector<dvec3> face_areas(std::span<const dvec3> world_points, const Polyhedron& hull,
                              std::span<const dmat4> world_from_body);

/// A normal for each characteristic point: the sum of the areas of the faces that meet in it, of unit length.
/// The normals of a box thus point into all eight octants, and those of a flat one to its two sides. A point
/// between faces without area has none (zero): it samples no side. Where no face has an area, lines and
/// points, they point away from the middle. Cost: O(triangles).
std::vector<dvec3> point_normals(std::span<const dvec3> world_points, const Polyhedron& hull,
                                 std::span<const dmat4> world_from_body);
/// The same, into `normals`, as many as there are points.
void point_normals(std::span<const dvec3> world_points, const Polyhedron& hull,
                   std::span<const dmat4> world_from_body, std::span<dvec3> normals);

/// The characteristic polyhedron of one layer.
struct LayerBound {
  BoundKind kind = BoundKind::Box8;
  int node = -1;           ///< space of `hull.points`; -1: world
  int axes_node = -1;      ///< where the points are recomputed: planes follow its axes; -1: the world's
  bool at_rest = false;    ///< nothing in the layer moves: `hull.points` are world points at every time
  Polyhedron hull;         ///< points are valid when fixed(); the triangles always are
  std::vector<int> parts;  ///< those it bounds, ascending
  /// One bound per part where the layer asks for it (LayerPreferences::bound_each_part), one per body where
  /// its parts move against each other, one per member in an aggregate (layers/aggregate.h); they may have
  /// bodies themselves. Then `hull` has the triangles of all of
  /// them, one after the other, and the points are theirs in the same order.
  std::vector<LayerBound> bodies;
  /// Material points of this body (not of `bodies`) beside the points of the hull: where it is not fixed, for
  /// its motion and its light; where it is, for its light alone and only if that is followed. What they say is
  /// an estimate (layers/surface_samples.h).
  std::vector<SurfaceSample> samples;

  /// Set where the layer's photometry is to be followed: then the characteristic points carry normals and
  /// colours (layers/state.h). The author of the bound decides; see layers/light_change.h.
  std::optional<MeanSurface> surface;
  std::string_view surface_why_not = "not asked for";  ///< why `surface` is not set
  bool follows_faces = false;  ///< the frames of the bodies are captured, to tell how its faces turn

  bool fixed() const { return node >= 0 || at_rest; }
};

/// One polyhedron for the whole, or the polyhedra of the parts together: the two ways to group bodies of
/// [LS97 3.1]. Parts that move against each other have one polyhedron for each that moves by itself, unless the
/// author asks for something else; what deforms has `material_points` samples beside its polyhedron. The one is fixed in `layer.rigid_node` where the layer has one, fixed in the world where
/// nothing in it moves. Otherwise the points are recomputed, along the axes of the lowest node above all its
/// parts and joints, so that the polyhedron turns with a layer that turns as a whole.
LayerBound make_layer_bound(const Scene& scene, const Layer& layer, BoundKind kind,
                            int material_points = kDefaultMaterialPoints);

/// Samples for the light of the bodies that have none yet. Cost: as spread_samples.
void add_light_samples(const Scene& scene, int material_points, LayerBound& bound);

/// Calls visit(body) for the bodies of a bound, or for itself where it has none, in their order.
template <typename Visit>
void for_each_body(const LayerBound& bound, const Visit& visit) {
  if (bound.bodies.empty()) return visit(bound);
  for (const LayerBound& body : bound.bodies) for_each_body(body, visit);
}

/// How many characteristic points the bound has wherever it has any.
int point_count(const LayerBound& bound);

/// World positions of the characteristic points at `frame`; none if the layer has no vertices or they are not
/// finite. Cost: O(points) if fixed, else O(vertices of the layer).
std::vector<dvec3> world_points(const SceneFrame& frame, const Layer& layer, const LayerBound& bound);

/// The same, appended to `points`, and without `layer`, of which nothing is asked.
void append_world_points(const SceneFrame& frame, const LayerBound& bound, std::vector<dvec3>& points);

/// The space that each body of the bound turns with: its node, or the node whose axes it follows; the world's
/// (identity) where it has none. One for a bound without bodies. Cost: O(bodies).
std::vector<dmat4> world_from_bodies(const SceneFrame& frame, const LayerBound& bound);
/// The same, appended.
void append_world_from_bodies(const SceneFrame& frame, const LayerBound& bound, std::vector<dmat4>& frames);

}  // namespace talisman::layers
