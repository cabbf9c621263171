// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "layers/polyhedron.h"

namespace talisman::layers {
namespace {

/// Scaled by its largest entry first: areas of a huge or tiny polyhedron have squares that over- or
/// underflow.
dvec3 unit_or_zero(const dvec3& v) {
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (!(largest > 0 && std::isfinite(largest))) return dvec3(0.0);
  return normalize(v / largest);
}

}  // namespace

std::vector<dvec3> face_areas(std::span<const dvec3> points, const Polyhedron& hull,
                              std::span<const dmat4> world_from_body) {
  TALISMAN_CHECK(!world_from_body.empty());
  const std::size_t faces_per_body = hull.face_ends.size() / world_from_body.size();
  std::vector<dvec3> areas;
  areas.reserve(hull.face_ends.size());
  int triangle = 0;
  for (std::size_t body = 0; body < world_from_body.size(); ++body) {
    const double sign = glm::determinant(glm::dmat3(world_from_body[body])) < 0 ? -1 : 1;
    for (std::size_t face = 0; face < faces_per_body; ++face) {
      dvec3 area(0.0);
      for (const int end = hull.face_ends[areas.size()]; triangle < end; ++triangle) {
        const auto& [a, b, c] = hull.triangles[triangle];
        area += cross(points[b] - points[a], points[c] - points[a]);
      }
      areas.push_back(sign * area);
    }
  }
  return areas;
}

std::vector<dvec3> point_normals(std::span<const dvec3> points, const Polyhedron& hull,
                                 std::span<const dmat4> world_from_body) {
  std::vector<dvec3> normals(points.size(), dvec3(0.0));
  const std::vector<dvec3> areas = face_areas(points, hull, world_from_body);
  int triangle = 0;
  for (std::size_t face = 0; face < areas.size(); ++face) {
    // A fan of n triangles has n + 2 corners: all of the first triangle, then one more of each.
    normals[hull.triangles[triangle][0]] += areas[face];
    normals[hull.triangles[triangle][1]] += areas[face];
    for (; triangle < hull.face_ends[face]; ++triangle) normals[hull.triangles[triangle][2]] += areas[face];
  }
  for (dvec3& normal : normals) normal = unit_or_zero(normal);
  if (std::any_of(normals.begin(), normals.end(), [](const dvec3& n) { return n != dvec3(0.0); }))
    return normals;
  dvec3 middle(0.0);
  for (const dvec3& p : points) middle += p / static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) normals[i] = unit_or_zero(points[i] - middle);
  return normals;
}

}  // namespace talisman::layers
