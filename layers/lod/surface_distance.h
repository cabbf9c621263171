// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far is the surface of one mesh from that of another?
///
///   d(A, B) = max over samples p of A of the distance from p to B          error = max(d(A, B), d(B, A))
///
/// Either way alone says nothing: of a level that has lost a leg, every point lies on the chair. Samples are the vertices
/// that triangles use, and as many more places again spread evenly over the area (a systematic choice of triangles by their
/// area, places inside by the additive recurrence of Roberts). The distance is true at the samples, and too small by at most
/// how far a point of the surface is from the nearest sample.
///
/// Of a mesh with morph targets it is the largest one of those at rest and with each target alone at weight 1, vertices of the
/// two being told apart by where they are at rest: a level has a choice of the vertices of its base. Of a skinned
/// mesh it is that in the pose of binding: where joints stretch it, the error stretches with them.

#include "layers/scene.h"

namespace talisman::layers {

struct SurfaceDistance {
  double from_base_m = 0;   ///< d(base, level)
  double from_level_m = 0;  ///< d(level, base)
  /// Mean over the area of the level of how its faces look along those of the base beside it: 1 the same way, -1 inside out.
  double facing = 1;
  double error_m() const { return from_base_m > from_level_m ? from_base_m : from_level_m; }
};

/// Places beside the vertices, on each of the two; at least kLeastSurfaceSamples, four for each triangle, at most kMostSurfaceSamples.
inline constexpr int kLeastSurfaceSamples = 512;
inline constexpr int kMostSurfaceSamples = 16'384;

/// Infinite where one of them has no triangles. Cost: O((vertices + samples) · log triangles), once per target.
SurfaceDistance surface_distance(const Mesh& base, const Mesh& level);

}  // namespace talisman::layers
