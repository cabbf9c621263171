// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where in a mesh is what? Boxes around a few triangles each.
///
/// A box around a whole mesh says where all of it may be, and nothing of one place on the display. Here the
/// triangles are halved at the median of their middles, along the axis along which these lie farthest apart,
/// until no more than `most` are left: clusters of neighbours, each with the box of its corners, in the mesh's
/// own space. What a rigid part shows of a cluster lies in the hull of that box's corners under any camera.
///
/// A triangle with a corner that is not finite is not drawn, and is in no cluster.

#include <cstdint>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

struct MeshCluster {
  dvec3 lo{0, 0, 0}, hi{0, 0, 0};  ///< of all corners of its triangles
  int triangles = 0;               ///< ≥ 1
};

/// Triangles (index / 3 of their first corner) of each cluster, as below: in 2^k groups where `most` is the 2^k-th part
/// of them, rounded up.
std::vector<std::vector<int>> triangle_groups(const Mesh& mesh, int most);

/// Each triangle in one cluster of at most `most` ≥ 1. The order is the same in every run. Cost: O(n log n).
std::vector<MeshCluster> mesh_clusters(const Mesh& mesh, int most);

}  // namespace talisman::layers
