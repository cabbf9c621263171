// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A 3×4 matrix by rows, in double: from world points to homogeneous points of a sprite or of a map.

#include "layers/geometry2.h"

namespace talisman::chunker {

/// Rows of a 3×4 matrix.
struct Rows34 {
  layers::dvec4 row[3];
  layers::dvec3 operator()(const layers::dvec3& p) const {
    return {row[0].x * p.x + row[0].y * p.y + row[0].z * p.z + row[0].w,
            row[1].x * p.x + row[1].y * p.y + row[1].z * p.z + row[1].w,
            row[2].x * p.x + row[2].y * p.y + row[2].z * p.z + row[2].w};
  }
};

}  // namespace talisman::chunker
