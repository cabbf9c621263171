// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "layers/polyhedron.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

/// Calls visit(face, area) for each face in order.
template <typename Visit>
void visit_face_areas(std::span<const dvec3> points, const Polyhedron& hull,
                      std::span<const dmat4> world_from_body, Visit visit) {
  TALISMAN_CHECK(!world_from_body.empty());
  const std::size_t faces_per_body = hull.face_ends.size() / world_from_body.size();
  int triangle = 0;
  for (std::size_t body = 0; body < world_from_body.size(); ++body) {
    const double sign = glm::determinant(glm::dmat3(world_from_body[body])) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < faces_per_body; ++k) {
      const std::size_t face = body * faces_per_body + k;
      dvec3 area(0.0);
      for (const int end = hull.face_ends[face]; triangle < end; ++triangle) {
        const auto& [a, b, c] = hull.triangles[triangle];
        area += cross(points[b] - points[a], points[c] - points[a]);
      }
      visit(face, sign * area);
    }
  }
}

/// For lines and points, where no face has an area.
void point_away_from_middle(std::span<const dvec3> points, std::span<dvec3> normals) {
  dvec3 middle(0.0);
  for (const dvec3& p : points) middle += p / static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) normals[i] = direction_or_zero(points[i] - middle);
}

}  // namespace

std::vector<dvec3> face_areas(std::span<const dvec3> points, const Polyhedron& hull,
                              std::span<const dmat4> world_from_body) {
  std::vector<dvec3> areas;
  areas.reserve(hull.face_ends.size());
  visit_face_areas(points, hull, world_from_body,
                   [&](std::size_t, const dvec3& area) { areas.push_back(area); });
  return areas;
}

void point_normals(std::span<const dvec3> points, const Polyhedron& hull,
                   std::span<const dmat4> world_from_body, std::span<dvec3> normals) {
  TALISMAN_CHECK_EQ(points.size(), normals.size());
  std::fill(normals.begin(), normals.end(), dvec3(0.0));
  visit_face_areas(points, hull, world_from_body, [&](std::size_t face, const dvec3& area) {
    // A fan of n triangles has n + 2 corners: all of the first triangle, then one more of each.
    int triangle = face == 0 ? 0 : hull.face_ends[face - 1];
    normals[hull.triangles[triangle][0]] += area;
    normals[hull.triangles[triangle][1]] += area;
    for (; triangle < hull.face_ends[face]; ++triangle) normals[hull.triangles[triangle][2]] += area;
  });
  bool some = false;
  for (dvec3& normal : normals) {
    normal = direction_or_zero(normal);
    some = some || normal != dvec3(0.0);
  }
  if (!some) point_away_from_middle(points, normals);
}

std::vector<dvec3> point_normals(std::span<const dvec3> points, const Polyhedron& hull,
                                 std::span<const dmat4> world_from_body) {
  std::vector<dvec3> normals(points.size());
  point_normals(points, hull, world_from_body, normals);
  return normals;
}

}  // namespace talisman::layers
