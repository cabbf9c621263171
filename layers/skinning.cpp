// SPDX-License-Identifier: Apache-2.0
#include "layers/built_effects.h"
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

bool is_morphed(const Mesh& mesh) { return is_built(Effect::Morphing) && !mesh.morphs.empty(); }

/// own + Σ weight · target.
std::vector<dvec3> sum_of(const std::vector<vec3>& own, const Mesh& mesh, const std::vector<double>& weights,
                          std::vector<vec3> MorphTarget::*member) {
  std::vector<dvec3> sum(own.begin(), own.end());
  for (std::size_t k = 0; k < mesh.morphs.size(); ++k) {
    const std::vector<vec3>& added = mesh.morphs[k].*member;
    if (weights[k] == 0 || added.empty()) continue;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weights[k] * dvec3(added[i]);
  }
  return sum;
}

/// Linear-blend skinning: p' = Σ wₖ Mₖ p / Σ wₖ. A vertex without weights follows the first joint it names.
dvec3 skinned_position(const Mesh& mesh, const dvec3& position, std::size_t vertex,
                       const std::vector<dmat4>& palette) {
  const dvec4 p(position, 1);
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

bool deforms(const Scene& scene, const Part& part) {
  return part.skin >= 0 || (part.mesh >= 0 && !scene.meshes[part.mesh].morphs.empty());
}

std::vector<double> morph_weights(const SceneFrame& frame, const Part& part) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  std::vector<double> weights;
  if (part.node >= 0 && static_cast<std::size_t>(part.node) < frame.morph_weights.size())
    weights = frame.morph_weights[part.node];
  weights.resize(mesh.morphs.size(), 0);
  return weights;
}

std::vector<dvec3> morphed_positions(const SceneFrame& frame, const Part& part) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  return sum_of(mesh.positions, mesh, morph_weights(frame, part), &MorphTarget::positions);
}

std::vector<dvec3> morphed_normals(const SceneFrame& frame, const Part& part) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  return sum_of(mesh.normals, mesh, morph_weights(frame, part), &MorphTarget::normals);
}

std::vector<dvec3> morphed_tangents(const SceneFrame& frame, const Part& part) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  std::vector<vec3> own;
  own.reserve(mesh.tangents.size());
  for (const vec4& tangent : mesh.tangents) own.emplace_back(tangent);
  return sum_of(own, mesh, morph_weights(frame, part), &MorphTarget::tangents);
}

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
  const bool morphed = is_morphed(mesh);
  if (part.skin < 0 && !morphed) return rigid_positions(mesh, world_from_node);
  std::vector<dvec3> moved = morphed ? morphed_positions(frame, part) : std::vector<dvec3>();
  if (part.skin < 0) {
    for (dvec3& p : moved) p = dvec3(world_from_node * dvec4(p, 1));
    return moved;
  }
  TALISMAN_CHECK_EQ(mesh.joints.size(), mesh.positions.size());
  TALISMAN_CHECK_EQ(mesh.weights.size(), mesh.positions.size());
  const std::vector<dmat4> palette = joint_palette(frame, part);
  std::vector<dvec3> world;
  world.reserve(mesh.positions.size());
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    world.push_back(
        skinned_position(mesh, morphed ? moved[vertex] : dvec3(mesh.positions[vertex]), vertex, palette));
  return world;
}

std::vector<dvec3> world_positions(const SceneFrame& frame, const Part& part,
                                   std::span<const std::uint32_t> vertices) {
  const Mesh& mesh = frame.scene->meshes.at(part.mesh);
  const dmat4 world_from_node = part.node < 0 ? dmat4(1) : frame.world_from_node.at(part.node);
  const std::vector<double> weights = is_morphed(mesh) ? morph_weights(frame, part) : std::vector<double>();
  const std::vector<dmat4> palette = joint_palette(frame, part);
  std::vector<dvec3> world;
  world.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) {
    dvec3 p(mesh.positions[vertex]);
    for (std::size_t k = 0; k < weights.size(); ++k)
      if (weights[k] != 0 && !mesh.morphs[k].positions.empty())
        p += weights[k] * dvec3(mesh.morphs[k].positions[vertex]);
    world.push_back(part.skin < 0 ? dvec3(world_from_node * dvec4(p, 1))
                                  : skinned_position(mesh, p, vertex, palette));
  }
  return world;
}

}  // namespace talisman::layers
