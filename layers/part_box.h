// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where in the world is a part? A box, without looking at its vertices again.
///
/// Rigid: the box of the mesh under the node's matrix. Morphed: p + Σ wₖ Δpₖ lies in the sum of the boxes of p and of
/// the Δpₖ times their weights. Skinned: p' = Σ wₖ Mₖ p / Σ wₖ with wₖ ≥ 0 lies in the hull of all Mₖ p. What
/// is not finite has no bounds (kEverywhere).

#include <vector>

#include "layers/region.h"
#include "layers/scene.h"

namespace talisman::layers {

/// The boxes of a mesh in its own space.
struct MeshBox {
  Box3 rest;                 ///< of its vertices; empty where there are none
  std::vector<Box3> morphs;  ///< of what each target adds
};
MeshBox mesh_box(const Mesh& mesh);
/// By mesh. Cost: O(vertices).
std::vector<MeshBox> mesh_boxes(const Scene& scene);

/// Cost: O(joints + targets).
Box3 part_box(const SceneFrame& frame, const Part& part, const MeshBox& mesh);

}  // namespace talisman::layers
