// SPDX-License-Identifier: Apache-2.0
#include "layers/part_box.h"

#include <algorithm>

namespace talisman::layers {
namespace {

Box3 box_of_floats(const std::vector<vec3>& points) {
  if (points.empty()) return {};
  Box3 box;
  float sum = 0;  // a NaN or an infinity anywhere is a NaN here
  for (const vec3& p : points)
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = std::min(box.lo[k], p[k]), box.hi[k] = std::max(box.hi[k], p[k]);
      sum += 0 * p[k];
    }
  return sum == 0 ? box : kEverywhere;
}

dvec3 lo_of(const Box3& box) { return {box.lo[0], box.lo[1], box.lo[2]}; }
dvec3 hi_of(const Box3& box) { return {box.hi[0], box.hi[1], box.hi[2]}; }

Box3 morphed(const SceneFrame& frame, const Part& part, const MeshBox& mesh) {
  dvec3 lo = lo_of(mesh.rest), hi = hi_of(mesh.rest), size(0);
  const std::vector<double> weights = morph_weights(frame, part);
  for (std::size_t k = 0; k < mesh.morphs.size(); ++k) {
    if (mesh.morphs[k].empty() || weights[k] == 0) continue;
    const dvec3 a = weights[k] * lo_of(mesh.morphs[k]), b = weights[k] * hi_of(mesh.morphs[k]);
    lo += glm::min(a, b), hi += glm::max(a, b);
    size += glm::max(glm::abs(a), glm::abs(b));
  }
  constexpr double kRounding = 1e-14;
  return box_of(lo - kRounding * size, hi + kRounding * size);
}

}  // namespace

MeshBox mesh_box(const Mesh& mesh) {
  MeshBox box{box_of_floats(mesh.positions), {}};
  for (const MorphTarget& target : mesh.morphs) box.morphs.push_back(box_of_floats(target.positions));
  return box;
}

std::vector<MeshBox> mesh_boxes(const Scene& scene) {
  std::vector<MeshBox> boxes;
  boxes.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) boxes.push_back(mesh_box(mesh));
  return boxes;
}

Box3 part_box(const SceneFrame& frame, const Part& part, const MeshBox& mesh) {
  if (mesh.rest.empty()) return {};
  const Box3 own = mesh.morphs.empty() ? mesh.rest : morphed(frame, part, mesh);
  if (part.skin < 0) return transformed(part.node < 0 ? dmat4(1) : frame.world_from_node[part.node], own);
  Box3 box;
  for (const dmat4& joint : joint_palette(frame, part)) box = joined(box, transformed(joint, own));
  return box.empty() ? kEverywhere : box;
}

}  // namespace talisman::layers
