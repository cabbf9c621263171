// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/tangents.h"
#include "sequences/import/gltf_scene.h"

namespace talisman::sequences {

namespace {

/// One of the file's own; a length that is not 1 is that of a quantised one.
bool is_direction(const layers::vec4& tangent) {
  const float length = glm::length(layers::vec3(tangent));
  return length > 1e-6f && std::isfinite(length) && std::isfinite(tangent.w) && tangent.w != 0;
}

void clear_tangents(layers::Mesh& mesh) {
  mesh.tangents.clear();
  for (layers::MorphTarget& morph : mesh.morphs) morph.tangents.clear();
}

/// Without a tangent anywhere there is no map at all.
std::string derive(layers::Mesh& mesh) {
  // Normals of triangles do not follow a shape that morphs.
  if (mesh.normals.empty() && !mesh.morphs.empty())
    return "normal maps of shapes that morph and have no normals are not drawn";
  if (mesh.normals.empty()) layers::make_flat_normals(mesh);
  const int without = layers::derive_tangents(mesh);
  if (without == mesh.triangle_count()) clear_tangents(mesh);
  return without > 0 ? "normal maps are not drawn where texture coordinates have no area" : "";
}

}  // namespace

std::string finish_gltf_tangents(const GltfMaterial& maps, layers::Mesh& mesh) {
  if (!maps.has_normal_map) return {};
  if (mesh.normal_uvs.empty() && (mesh.uvs.empty() || !(maps.normal == maps.base))) {
    clear_tangents(mesh);
    return "normal maps without texture coordinates are not drawn";
  }
  if (mesh.tangents.empty()) return derive(mesh);
  if (!std::all_of(mesh.tangents.begin(), mesh.tangents.end(), is_direction)) {
    clear_tangents(mesh);
    const std::string lacking = derive(mesh);
    return !lacking.empty() ? lacking
                            : "tangents without a direction are replaced by those of the texture coordinates";
  }
  for (layers::vec4& t : mesh.tangents)
    t = layers::vec4(glm::normalize(layers::vec3(t)), t.w < 0 ? -1.0f : 1.0f);
  return {};
}

}  // namespace talisman::sequences
