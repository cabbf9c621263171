// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Four floats that are computed together: a premultiplied colour (r, g, b, a), a direction or a texture
/// coordinate.
///
/// It is the vector type of gcc and clang: every operator works lane by lane with ordinary rounding, so
/// results are the same bits on every processor.

#include <cmath>

#include "layers/geometry2.h"

namespace talisman::chunker {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 splat(float v) { return Float4{v, v, v, v}; }
inline Float4 float4(const layers::vec3& v, float w = 0) { return Float4{v.x, v.y, v.z, w}; }

inline bool all_ones(Float4 v) { return v[0] == 1 && v[1] == 1 && v[2] == 1 && v[3] == 1; }

/// Sum of the products of the first three lanes.
inline float dot3(Float4 a, Float4 b) {
  const Float4 p = a * b;
  return (p[0] + p[1]) + p[2];
}

inline Float4 cross3(Float4 a, Float4 b) {
  return Float4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

/// Unit vector along the first three lanes; zero where there is no direction.
inline Float4 normalized3(Float4 v) {
  const float squared = dot3(v, v);
  return squared > 0 ? v * splat(1 / std::sqrt(squared)) : splat(0);
}

}  // namespace talisman::chunker
