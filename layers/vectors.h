// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small questions about vectors that several files ask.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/geometry2.h"

namespace talisman::layers {

/// Neither NaN nor infinite. Without a branch: shading asks it for every point and light.
inline bool is_finite(const dvec3& v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0; }
/// Of unit length; zero where it has no length or is not finite. Scaled by its largest entry first: areas of huge
/// or tiny things have squares that over- or underflow.
inline dvec3 direction_or_zero(const dvec3& v) {
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return largest > 0 && std::isfinite(largest) ? glm::normalize(v / largest) : dvec3(0.0);
}

inline bool is_zero(const vec3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace talisman::layers
