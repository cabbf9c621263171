// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/unit_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::vec3;

bool has_direction(float length) { return length > 1e-12f && std::isfinite(length); }

/// Sums of the triangles at each vertex, twice their areas long.
std::vector<dvec3> triangle_sums(const layers::Mesh& mesh) {
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    if (std::max({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}) >= sums.size()) continue;
    const auto at = [&](std::size_t corner) { return dvec3(mesh.positions[mesh.indices[i + corner]]); };
    const dvec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
    for (std::size_t corner = 0; corner < 3; ++corner) sums[mesh.indices[i + corner]] += normal;
  }
  return sums;
}

vec3 unit_or_up(const dvec3& sum) {
  const double length = glm::length(sum);
  return length > 0 && std::isfinite(length) ? vec3(sum / length) : vec3(0, 1, 0);
}

}  // namespace

std::size_t make_unit_normals(layers::Mesh& mesh) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const float length = glm::length(mesh.normals[i]);
    if (has_direction(length))
      mesh.normals[i] /= length;
    else
      without.push_back(i);
  }
  if (without.empty()) return 0;
  const std::vector<dvec3> sums = triangle_sums(mesh);
  for (const std::size_t i : without) mesh.normals[i] = unit_or_up(sums[i]);
  return without.size();
}

}  // namespace talisman::sequences
