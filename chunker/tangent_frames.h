// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where do u and v of a normal map grow in the world, at each vertex of a part?
///
///   t' = M t      M: linear part of world_from_node, or Σ wₖ Mₖ of the joints; morph targets are added before
///   ±' = ± sign(det M)
///
/// Tangents lie in the surface and go the way that it goes, by M; its normal goes by M⁻ᵀ. A mirroring M turns
/// normal × tangent over against what it stands for, so the sign goes with it. (Joints have no sign of their
/// own: their normals are mirrored along, chunker/transform.h.)

#include <vector>

#include "chunker/shade.h"

namespace talisman::chunker {

/// Writes the attributes `tangent` and `normal_uv` of all vertices. `backs`: a second copy of the vertices follows
/// the first, seen from behind; their tangents are turned, and their signs, so that the bitangents are too. Cost:
/// O(vertices).
void write_tangent_frames(const layers::SceneFrame& frame, const layers::Part& part,
                          const AttributeLayout& layout, bool backs, std::vector<Float4>& attributes);

}  // namespace talisman::chunker
