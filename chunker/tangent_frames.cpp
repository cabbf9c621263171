// SPDX-License-Identifier: Apache-2.0
#include "chunker/tangent_frames.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/vectors.h"

namespace talisman::chunker {
namespace {

using layers::dmat3;
using layers::dmat4;
using layers::dvec3;
using layers::vec4;

/// How the tangents of one part get into the world.
class Tangents {
 public:
  Tangents(const layers::SceneFrame& frame, const layers::Part& part)
      : mesh_(frame.scene->meshes[part.mesh]) {
    if (layers::is_built(layers::Effect::Morphing) && !mesh_.morphs.empty())
      morphed_ = layers::morphed_tangents(frame, part);
    if (layers::is_built(layers::Effect::Skinning) && part.skin >= 0 && !mesh_.joints.empty()) {
      for (const dmat4& joint : layers::joint_palette(frame, part)) joints_.emplace_back(joint);
    } else if (part.node >= 0) {
      world_from_mesh_ = dmat3(frame.world_from_node[part.node]);
      sign_ = glm::determinant(world_from_mesh_) < 0 ? -1.0f : 1.0f;
    }
  }

  /// Zero where there is none.
  Float4 in_world(std::size_t i) const {
    const vec4& own = mesh_.tangents[i];
    const dvec3 tangent = morphed_.empty() ? dvec3(own) : morphed_[i];
    const dvec3 world = joints_.empty() ? world_from_mesh_ * tangent : by_joints(tangent, i);
    const double length = glm::length(world);  // in double: a scene of 1e-15 units would vanish in float
    if (!(length > 0 && layers::is_finite(world))) return splat(0);
    return float4(layers::vec3(world / length), own.w * sign_);
  }

 private:
  dvec3 by_joints(const dvec3& tangent, std::size_t i) const {
    dvec3 sum(0.0);
    for (int k = 0; k < 4; ++k)
      sum += static_cast<double>(mesh_.weights[i][k]) * (joints_[mesh_.joints[i][k]] * tangent);
    return sum;
  }

  const layers::Mesh& mesh_;
  std::vector<dvec3> morphed_;
  std::vector<dmat3> joints_;
  dmat3 world_from_mesh_{1.0};
  float sign_ = 1;
};

}  // namespace

void write_tangent_frames(const layers::SceneFrame& frame, const layers::Part& part,
                          const AttributeLayout& layout, bool backs, std::vector<Float4>& attributes) {
  const layers::Mesh& mesh = frame.scene->meshes[part.mesh];
  const Tangents tangents(frame, part);
  const std::vector<layers::vec2>& uvs = mesh.normal_uvs.empty() ? mesh.uvs : mesh.normal_uvs;
  const std::size_t count = static_cast<std::size_t>(layout.count), n = mesh.positions.size();
  const auto write = [&](std::size_t vertex, Float4 tangent, Float4 uv) {
    attributes[vertex * count + static_cast<std::size_t>(layout.tangent)] = tangent;
    attributes[vertex * count + static_cast<std::size_t>(layout.normal_uv)] = uv;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Float4 tangent = tangents.in_world(i);
    const Float4 uv{usable_coordinate(uvs[i].x), usable_coordinate(uvs[i].y), 0, 0};
    write(i, tangent, uv);
    if (backs) write(i + n, -tangent, uv);
  }
}

}  // namespace talisman::chunker
