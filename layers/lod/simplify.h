// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A mesh at fewer and fewer triangles.
///
/// libmeshoptimizer (Garland & Heckbert 1997, quadrics) takes edges away, each time the one whose loss moves the surface
/// least; what is left are vertices of the mesh as they were. So a level has the joints, weights, morph targets and
/// everything else that its vertices had, and moves as the mesh does. Vertices in one place that differ in anything
/// (texture coordinates at a seam, normals at a crease) are taken away along their seam only, both sides at once.
/// Vertices that do not differ at all are taken for one first: else each triangle that has its own would be held.
///
/// Each level is made from the mesh itself and has at most half of the triangles of the one above. Its error is measured
/// (layers/lod/surface_distance.h), not the simplifier's estimate. The ladder ends where a level cannot be had: nothing more
/// can be taken away, it would be empty, turned inside out, or too far off.

#include <string>
#include <vector>

#include "layers/lod/ladder.h"
#include "layers/scene.h"

namespace talisman::layers {

struct LadderOptions {
  int most_levels = 5;      ///< ≥ 1, level 0 included; more are coarser still [Fu93: five]
  int least_triangles = 8;  ///< ≥ 1 of a level; fewer are coarser still
  double most_error =
      0.125;  ///< > 0: of a level, as a share of the diagonal of the mesh; more is coarser still
  bool lock_borders =
      false;  ///< edges with a triangle on one side only stay as they are: where tiles and terrain meet
};

/// The levels below a mesh, and the figures of all.
struct BuiltLadder {
  Ladder ladder;              ///< level 0 is the mesh; one level alone: nothing coarser can be had
  std::vector<Mesh> coarser;  ///< levels 1, 2, …
  std::string ended_by;       ///< why there is no further one, in words
};

/// By simplification. A mesh without triangles has no level. Cost: O(n log n) per level.
BuiltLadder build_ladder(const Mesh& mesh, const LadderOptions& options = {});

/// By meshes that others have made, finest first. `ended_by` is the first broken rule, or empty: then all are in it.
BuiltLadder ladder_of(const Mesh& mesh, std::vector<Mesh> coarser);

/// Of its vertex arrays and indices.
std::int64_t mesh_bytes(const Mesh& mesh);

/// What looks the wrong way: the mean of SurfaceDistance::facing below this is inside out.
inline constexpr double kInsideOut = 0;

}  // namespace talisman::layers
