// SPDX-License-Identifier: Apache-2.0
#include "layers/check.h"
#include "layers/scene.h"

namespace talisman::layers {

namespace {

std::vector<dvec3> rigid_positions(const Mesh& mesh, const dmat4& world_from_node) {
  std::vector<dvec3> world;
  world.reserve(mesh.positions.size());
  for (const vec3& position : mesh.positions) world.emplace_back(world_from_node * dvec4(position, 1));
  return world;
}

/// Linear-blend skinning: p' = Σ wₖ Mₖ p / Σ wₖ. A vertex without weights follows the first joint it names.
dvec3 skinned_position(const Mesh& mesh, std::size_t vertex, const std::vector<dmat4>& palette) {
  const dvec4 p(mesh.positions[vertex], 1);
  const glm::uvec4& joints = mesh.joints[vertex];
  const vec4& weights = mesh.weights[vertex];
  dvec3 sum{0, 0, 0};
  double total = 0;
  for (int k = 0; k < 4; ++k) {
    const double weight = weights[k];
    if (weight == 0) continue;
    sum += weight * dvec3(palette.at(joints[k]) * p);
    total += weight;
  }
  return total > 0 ? sum / total : dvec3(palette.at(joints[0]) * p);
}

}  // namespace

std::vector<dmat4> joint_palette(const SceneFrame& frame, const Part& part) {
  if (part.skin < 0) return {};
  const Skin& skin = frame.scene->skins.at(part.skin);
  TALISMAN_CHECK_EQ(skin.joints.size(), skin.joint_from_mesh.size());
  std::vector<dmat4> palette;
  palette.reserve(skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i)
    palette.push_back(frame.world_from_node.at(skin.joints[i]) * skin.joint_from_mesh[i]);
  return palette;
}

std::vector<dvec3> world_positions(const SceneFrame& frame, const Part& part) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  const dmat4 world_from_node = part.node < 0 ? dmat4(1) : frame.world_from_node.at(part.node);
  if (part.skin < 0) return rigid_positions(mesh, world_from_node);
  TALISMAN_CHECK_EQ(mesh.joints.size(), mesh.positions.size());
  TALISMAN_CHECK_EQ(mesh.weights.size(), mesh.positions.size());
  const std::vector<dmat4> palette = joint_palette(frame, part);
  std::vector<dvec3> world;
  world.reserve(mesh.positions.size());
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    world.push_back(skinned_position(mesh, vertex, palette));
  return world;
}

}  // namespace talisman::layers
