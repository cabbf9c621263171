// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/far_plane.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

std::string beyond_far_plane(const layers::Scene& scene, const layers::Camera& camera) {
  if (camera.node < 0) return {};
  const layers::SceneFrame frame = scene.at(0);
  const layers::dmat4& world = frame.world_from_node[static_cast<std::size_t>(camera.node)];
  const layers::dvec3 eye(world[3]), back = glm::normalize(layers::dvec3(world[2]));
  const double limit = camera.far_m * (1 + 1e-6);
  for (const layers::Part& part : scene.parts)
    for (const layers::dvec3& place : layers::world_positions(frame, part))
      if (glm::dot(eye - place, back) > limit)
        return "what lies beyond the far plane of camera '" + camera.name + "', " +
               formatted("%g", camera.far_m) + " m, is drawn all the same";
  return {};
}

}  // namespace talisman::sequences
