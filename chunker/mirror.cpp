// SPDX-License-Identifier: Apache-2.0
#include "chunker/mirror.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::chunker {

layers::SceneFrame mirrored_frame(const layers::SceneFrame& frame, layers::dvec3 point,
                                  layers::dvec3 normal) {
  layers::SceneFrame mirrored = frame;
  const double length = glm::length(normal), d = length > 0 ? glm::dot(point, normal / length) : 0;
  if (!(length > 0 && std::isfinite(length) && std::isfinite(d))) return mirrored;
  const layers::dvec3 n = normal / length;
  layers::dmat4 reflect(1.0);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) reflect[column][row] -= 2 * n[row] * n[column];
  reflect[3] = layers::dvec4(2 * d * n, 1);
  mirrored.camera.world_from_camera = reflect * frame.camera.world_from_camera;
  return mirrored;
}

}  // namespace talisman::chunker
