// SPDX-License-Identifier: Apache-2.0
#include "layers/prediction_primitive.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talisman::layers {

namespace {

constexpr std::size_t kMostOfPolygon = 6;

/// The positions that triangles use, each once.
std::vector<dvec3> used_positions(const Mesh& mesh) {
  std::vector<bool> seen(mesh.positions.size());
  std::vector<dvec3> used;
  for (const std::uint32_t index : mesh.indices) {
    if (seen[index]) continue;
    seen[index] = true;
    used.emplace_back(mesh.positions[index]);
  }
  const auto before = [](const dvec3& a, const dvec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  std::sort(used.begin(), used.end(), before);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

std::vector<dvec3> corners(const dvec3& lo, const dvec3& hi) {
  std::vector<dvec3> points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  return points;
}

}  // namespace

std::string_view name(PrimitiveKind kind) {
  switch (kind) {
    case PrimitiveKind::Polygon:
      return "polygon";
    case PrimitiveKind::Block:
      return "block";
    case PrimitiveKind::Octahedron:
      return "octahedron";
  }
  return "?";
}

PredictionPrimitive prediction_primitive(const Mesh& mesh) {
  std::vector<dvec3> used = used_positions(mesh);
  if (used.size() <= kMostOfPolygon) return {PrimitiveKind::Polygon, std::move(used)};
  dvec3 lo(std::numeric_limits<double>::infinity()), hi(-std::numeric_limits<double>::infinity());
  for (const dvec3& p : used) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  const dvec3 middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  double reach = 0;  // of the octahedron, in halves of the bounds
  for (const dvec3& p : used) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (half[axis] > 0) sum += std::abs(p[axis] - middle[axis]) / half[axis];
    reach = std::max(reach, sum);
  }
  // Volumes over that of half.x half.y half.z: 8 and 4/3 reach³. A flat body has neither; its block has as many points.
  if (!(reach * reach * reach < 6)) return {PrimitiveKind::Block, corners(lo, hi)};
  PredictionPrimitive octahedron{PrimitiveKind::Octahedron, {}};
  reach *= 1 + 1e-9;  // rounding of the sums stays inside
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 point = middle;
      point[axis] += side * reach * half[axis];
      octahedron.points.push_back(point);
    }
  return octahedron;
}

}  // namespace talisman::layers
