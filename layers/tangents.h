// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which way do u and v grow on a surface? Tangents of a mesh that brings none, for its normal map.
///
/// In a triangle with edges e₁, e₂ whose coordinates differ by (u₁, v₁), (u₂, v₂)
///
///   a = u₁ v₂ - u₂ v₁       tangent    ∂p/∂u = (v₂ e₁ - v₁ e₂) / a
///                           bitangent -∂p/∂v = (u₂ e₁ - u₁ e₂) / a      v grows downwards in a picture, y upwards
///                           sign       of -a: seen from its front a triangle has e₁ × e₂ towards the eye, and
///                                      normal × tangent = sign · bitangent
///
/// At a vertex: the triangles' tangents in the plane of its normal, of unit length, weighted by the triangle's
/// angle there, summed over all triangles of one sign whose corners have the same place, normal and coordinates;
/// that is the rule of MikkTSpace, but that it sums only over triangles connected by edges. Where triangles of both
/// signs meet, as in the middle of a surface whose picture is mirrored, the vertex becomes two. A triangle whose
/// coordinates have no area adds nothing; a corner that only such triangles have gets no tangent.
///
/// Morph targets move the tangents: by the difference that the target alone, at weight 1, makes to them.

#include "layers/scene.h"

namespace talisman::layers {

/// Sets `tangents` of a mesh that has normals and coordinates (`normal_uvs`, else `uvs`), and those of its morph targets.
/// Returns how many triangles have no tangent at any corner: no map is seen there. Vertices may be added at the end. Cost: O((vertices + triangles) · log · morph targets).
int derive_tangents(Mesh& mesh);

/// Gives each triangle vertices of its own, with the triangle's normal: a mesh without normals, for a map that
/// needs them. Cost: O(triangles).
void make_flat_normals(Mesh& mesh);

}  // namespace talisman::layers
