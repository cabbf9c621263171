// SPDX-License-Identifier: Apache-2.0
#include "layers/placed.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace talisman::layers {

bool is_finite(const dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

std::optional<Placed> placed(const dmat4& m) {
  constexpr double kFlatStretch =
      1e-9;  // an axis shorter than this share of the longest has no direction to rely on
  const dmat3 linear(m);
  const double longest = std::max({length(linear[0]), length(linear[1]), length(linear[2])});
  const double x = length(linear[0]);
  if (!(longest > 0) || !(x > kFlatStretch * longest)) return std::nullopt;
  dmat3 r;
  r[0] = linear[0] / x;
  const dvec3 rest = linear[1] - r[0] * dot(r[0], linear[1]);
  const double y = length(rest);
  if (!(y > kFlatStretch * longest)) return std::nullopt;
  r[1] = rest / y;
  r[2] = cross(r[0], r[1]);
  const dmat3 stretch = transpose(r) * linear;
  if (!(std::fabs(stretch[2][2]) > kFlatStretch * longest)) return std::nullopt;
  return Placed{r, stretch, dvec3(m[3])};
}

dvec3 rotation_vector(const dmat3& rotation) {
  glm::dquat q = glm::normalize(glm::quat_cast(rotation));
  if (q.w < 0) q = -q;
  const double sine = std::hypot(q.x, q.y, q.z);
  if (sine == 0) return dvec3{0};
  return dvec3(q.x, q.y, q.z) * (2 * std::atan2(sine, q.w) / sine);
}

}  // namespace talisman::layers
