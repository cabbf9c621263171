// SPDX-License-Identifier: Apache-2.0
#include "chunker/mirror.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::chunker {

namespace {

/// The plane n · p = d with n of unit length; empty where there is none.
std::optional<HalfSpace> unit_plane(const layers::dvec3& point, const layers::dvec3& normal) {
  const double length = glm::length(normal), d = length > 0 ? glm::dot(point, normal / length) : 0;
  if (!(length > 0 && std::isfinite(length) && std::isfinite(d))) return std::nullopt;
  return HalfSpace{normal / length, d};
}

}  // namespace

layers::SceneFrame mirrored_frame(const layers::SceneFrame& frame, layers::dvec3 point,
                                  layers::dvec3 normal) {
  layers::SceneFrame mirrored = frame;
  const std::optional<HalfSpace> plane = unit_plane(point, normal);
  if (!plane) return mirrored;
  const layers::dvec3 n = plane->normal;
  layers::dmat4 reflect(1.0);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) reflect[column][row] -= 2 * n[row] * n[column];
  reflect[3] = layers::dvec4(2 * plane->offset * n, 1);
  mirrored.camera.world_from_camera = reflect * frame.camera.world_from_camera;
  return mirrored;
}

std::optional<HalfSpace> before_mirror(const layers::SceneFrame& frame, layers::dvec3 point,
                                       layers::dvec3 normal) {
  std::optional<HalfSpace> plane = unit_plane(point, normal);
  if (plane && plane->height(layers::dvec3(frame.camera.world_from_camera[3])) < 0)
    plane = HalfSpace{-plane->normal, -plane->offset};
  return plane;
}

}  // namespace talisman::chunker
