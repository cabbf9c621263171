// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A vertex of one mesh as the next of another: all that a rigid mesh has of it.

#include <cstdint>

#include "layers/scene.h"

namespace talisman::layers {

/// Joints, weights and morph targets are left out. Cost: O(1).
inline void append_rigid_vertex(const Mesh& from, std::uint32_t vertex, Mesh& to) {
  const auto append = [vertex](const auto& values, auto& copies) {
    if (!values.empty()) copies.push_back(values[vertex]);
  };
  append(from.positions, to.positions);
  append(from.normals, to.normals);
  append(from.uvs, to.uvs);
  append(from.emissive_uvs, to.emissive_uvs);
  append(from.normal_uvs, to.normal_uvs);
  append(from.tangents, to.tangents);
  append(from.colors, to.colors);
  append(from.alphas, to.alphas);
}

}  // namespace talisman::layers
