// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Characteristic bounding polyhedra [LS97 3.1].
///
/// The motion of a layer is tracked by a small convex polyhedron around its geometry. Its vertices are the
/// characteristic points. For a rigid layer they are fixed in the space of the node that carries it; for a layer whose
/// parts deform or move against each other they are recomputed at each time, with the same indices (point i always is the same
/// corner of the same set of planes), so that point i then and point i now can be matched.

#include <array>
#include <span>
#include <vector>

#include "layers/layer.h"

namespace talisman::layers {

/// Which planes bound the layer. Box8: 6 planes, 8 points. Dop14: box with its corners cut, 14 planes, 24 points.
/// Dop26: corners and edges cut, 26 planes, 48 points. More planes follow the shape more tightly and cost time in every fit.
enum class BoundKind { Box8, Dop14, Dop26 };

/// A closed convex polyhedron with fixed topology per kind (degenerate edges and faces are allowed).
struct Polyhedron {
  std::vector<dvec3> points;
  std::vector<std::array<int, 3>> triangles;  ///< fan triangulation of the faces, counter-clockwise from outside
};

/// The bounding polyhedron of a point set: contains every point (to rounding, 1e-9 of the extent). An empty or non-finite
/// set gives no points. Cost: O(points · planes).
Polyhedron bounding_polyhedron(std::span<const dvec3> points, BoundKind kind);

/// The characteristic polyhedron of one layer.
struct LayerBound {
  BoundKind kind = BoundKind::Box8;
  int node = -1;        ///< space of `hull.points`; -1: world, and the points are recomputed at each time
  Polyhedron hull;      ///< points are valid when node ≥ 0; the triangles always are
};

LayerBound make_layer_bound(const Scene& scene, const Layer& layer, BoundKind kind);

/// World positions of the characteristic points at `frame`. Cost: O(points) if rigid, else O(vertices of the layer).
std::vector<dvec3> world_points(const SceneFrame& frame, const Layer& layer, const LayerBound& bound);

}  // namespace talisman::layers
