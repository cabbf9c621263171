// SPDX-License-Identifier: Apache-2.0
#include "layers/mesh_subset.h"

#include <utility>
#include <vector>

namespace talisman::layers {

Mesh with_triangles(const Mesh& mesh, std::span<const std::uint32_t> indices) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> place(mesh.positions.size(), kUnused), kept;
  for (const std::uint32_t v : indices) place[v] = 0;
  for (std::uint32_t v = 0; v < place.size(); ++v)
    if (place[v] != kUnused) {
      place[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
  Mesh result = mesh;
  for_each_array(result, [&](auto& array) {
    if (array.empty()) return;
    auto all = std::move(array);
    array.clear();
    array.reserve(kept.size());
    for (const std::uint32_t v : kept) array.push_back(all[v]);
  });
  result.indices.clear();
  for (const std::uint32_t v : indices) result.indices.push_back(place[v]);
  return result;
}

}  // namespace talisman::layers
