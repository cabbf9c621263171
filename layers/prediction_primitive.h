// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which few points carry the motion of all that a part shows? The prediction primitives of [F96 3.1.1].
///
///   polygon      its own vertices, where they are few
///   block        the eight corners of a box
///   octahedron   six points: |x|/a + |y|/b + |z|/c ≤ 1 about the middle of the bounds, with a : b : c as the sides of
///                the bounds and just large enough; around a sphere of radius r it is √3 r
///
/// Each encloses the mesh, so that what holds for the convex hull of its points holds for every surface of the part.
/// The cost of following a part is in proportion to its points: a sphere of 400 polygons has 6.

#include <string_view>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

enum class PrimitiveKind { Polygon, Block, Octahedron };
std::string_view name(PrimitiveKind kind);  ///< "polygon", "block", "octahedron"

struct PredictionPrimitive {
  PrimitiveKind kind = PrimitiveKind::Polygon;
  std::vector<dvec3> points;  ///< in the space of the mesh
};

/// Of the vertices that the triangles use: up to six different ones are a polygon; else the smaller by volume of block
/// and octahedron. A mesh without triangles has no points. Cost: O(indices).
PredictionPrimitive prediction_primitive(const Mesh& mesh);

}  // namespace talisman::layers
