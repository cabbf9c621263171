// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Some triangles of a mesh as a mesh of their own, and what a mesh has of each vertex.

#include <cstdint>
#include <span>

#include "layers/scene.h"

namespace talisman::layers {

/// All arrays of vertices in turn. `mesh` may be const.
template <typename M, typename F>
void for_each_array(M& mesh, const F& visit) {
  visit(mesh.positions);
  visit(mesh.normals);
  visit(mesh.uvs);
  visit(mesh.emissive_uvs);
  visit(mesh.normal_uvs);
  visit(mesh.tangents);
  visit(mesh.colors);
  visit(mesh.alphas);
  visit(mesh.joints);
  visit(mesh.weights);
  for (auto& morph : mesh.morphs) {
    visit(morph.positions);
    visit(morph.normals);
    visit(morph.tangents);
  }
}

/// The mesh with these triangles alone, three indices each, and the vertices that they use, in their order. Cost: O(mesh).
Mesh with_triangles(const Mesh& mesh, std::span<const std::uint32_t> indices);

}  // namespace talisman::layers
