// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small questions about vectors that several files ask.

#include "layers/geometry2.h"

namespace talisman::layers {

/// Neither NaN nor infinite. Without a branch: shading asks it for every point and light.
inline bool is_finite(const dvec3& v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0; }
inline bool is_zero(const vec3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace talisman::layers
