// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Boxes, cameras and a slow answer, for the tests of regions and of the structures that are asked about them.

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "layers/region.h"

namespace talisman::layers {

/// `count` boxes within `size_m` of `centre`; clustered: nine in ten in one of 50 heaps of a fiftieth of it, and as
/// much smaller.
inline std::vector<Box3> boxes_by_lot(int count, double size_m, bool clustered, unsigned seed,
                                      const dvec3& centre = {0, 0, 0}) {
  constexpr int kHeaps = 50;
  std::mt19937 lot(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto anywhere = [&] { return dvec3(unit(lot), unit(lot), unit(lot)); };
  std::vector<dvec3> heaps(kHeaps);
  for (dvec3& heap : heaps) heap = anywhere();
  std::vector<Box3> boxes;
  for (int i = 0; i < count; ++i) {
    const bool is_heaped = clustered && i % 10 != 0;
    const double scale = is_heaped ? 1.0 / kHeaps : 1;
    const dvec3 middle = (is_heaped ? heaps[i % kHeaps] : dvec3(0)) + scale * anywhere(),
                half = 0.01 * scale * glm::abs(anywhere());
    boxes.push_back(box_of(centre + size_m * (middle - half), centre + size_m * (middle + half)));
  }
  return boxes;
}

inline CameraState camera_by_lot(std::mt19937& lot, double size_m, const dvec3& centre = {0, 0, 0}) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto rotation = look_rotation(dvec3(unit(lot), unit(lot), unit(lot)), {0, 0, -1}, unit(lot));
  dmat4 world(glm::mat4_cast(rotation));
  world[3] = dvec4(centre + size_m * dvec3(unit(lot), unit(lot), unit(lot)), 1);
  return {world, 0.2 + 0.6 * std::fabs(unit(lot)), 1e-3 * size_m, 100 * size_m};
}

/// In long double, corner by corner: is the box surely outside of the region, by more than `by` of the coordinates?
inline bool is_outside(std::span<const Plane> region, const Box3& box) {
  if (box.empty()) return true;
  for (const Plane& plane : region) {
    bool some_inside = false;
    for (int corner = 0; corner < 8; ++corner) {
      long double height = plane.offset;
      for (int k = 0; k < 3; ++k)
        height += static_cast<long double>(plane.normal[k]) * (corner >> k & 1 ? box.hi[k] : box.lo[k]);
      some_inside = some_inside || height >= 0;
    }
    if (!some_inside) return true;
  }
  return false;
}

/// Must be found; the others may be.
inline std::set<int> met_slowly(std::span<const Plane> region, std::span<const Box3> boxes) {
  std::set<int> met;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!is_outside(region, boxes[i])) met.insert(static_cast<int>(i));
  return met;
}

}  // namespace talisman::layers
