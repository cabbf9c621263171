// SPDX-License-Identifier: Apache-2.0
#include "layers/tangents.h"

#include <array>
#include <bit>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "layers/check.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr double kFlat = 1e-7;     ///< of the product of two edges: less is rounding of float coordinates
constexpr double kOpposed = 1e-6;  ///< of the weights: less is left where tangents cancel each other

const std::vector<vec2>& coordinates_of(const Mesh& mesh) {
  return mesh.normal_uvs.empty() ? mesh.uvs : mesh.normal_uvs;
}

using Corners = std::array<std::uint32_t, 3>;

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* first = &mesh.indices[3 * triangle];
  return {first[0], first[1], first[2]};
}

struct CoordinateEdges {
  dvec2 one, two;
  double area() const { return one.x * two.y - one.y * two.x; }
  /// 1, -1, or 0 where there is no area.
  int sign() const {
    const double a = area();
    if (!(std::fabs(a) > kFlat * glm::length(one) * glm::length(two))) return 0;
    return a < 0 ? 1 : -1;
  }
};

CoordinateEdges edges_of(const Mesh& mesh, const Corners& corner) {
  const std::vector<vec2>& uv = coordinates_of(mesh);
  const dvec2 origin(uv[corner[0]]);
  return {dvec2(uv[corner[1]]) - origin, dvec2(uv[corner[2]]) - origin};
}

dvec3 in_plane(const dvec3& v, const dvec3& normal) {
  return direction_or_zero(v - glm::dot(v, normal) * normal);
}

/// Numbers that are the same for vertices of the same place, normal and coordinates.
std::vector<int> groups_of(const Mesh& mesh) {
  using Key = std::array<std::uint32_t, 8>;
  std::map<Key, int> known;
  std::vector<int> groups;
  const std::vector<vec2>& uv = coordinates_of(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const vec3 &p = mesh.positions[i], &n = mesh.normals[i];
    const std::array<float, 8> values{p.x, p.y, p.z, n.x, n.y, n.z, uv[i].x, uv[i].y};
    Key key;
    for (std::size_t k = 0; k < key.size(); ++k) key[k] = std::bit_cast<std::uint32_t>(values[k] + 0.0f);
    groups.push_back(known.emplace(key, static_cast<int>(known.size())).first->second);
  }
  return groups;
}

void copy_vertex(Mesh& mesh, std::uint32_t vertex) {
  const auto copy = [vertex](auto& values) {
    if (values.empty()) return;
    const auto value = values[vertex];
    values.push_back(value);
  };
  copy(mesh.positions), copy(mesh.normals), copy(mesh.uvs), copy(mesh.emissive_uvs), copy(mesh.normal_uvs);
  copy(mesh.colors), copy(mesh.alphas), copy(mesh.joints), copy(mesh.weights), copy(mesh.tangents);
  for (MorphTarget& morph : mesh.morphs) copy(morph.positions), copy(morph.normals), copy(morph.tangents);
}

/// The sign of the triangles at each vertex, 0: of none. Vertices between triangles of both become two.
std::vector<int> split_by_sign(Mesh& mesh, std::vector<int>& groups) {
  std::vector<int> signs(mesh.positions.size(), 0);
  std::map<std::uint32_t, std::uint32_t> copies;
  for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t) {
    const int sign = edges_of(mesh, corners_of(mesh, t)).sign();
    if (sign == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& vertex = mesh.indices[3 * t + k];
      if (signs[vertex] == 0) signs[vertex] = sign;
      if (signs[vertex] == sign) continue;
      const auto [copy, is_new] = copies.emplace(vertex, static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) {
        copy_vertex(mesh, vertex);
        groups.push_back(groups[vertex]);
        signs.push_back(sign);
      }
      vertex = copy->second;
    }
  }
  return signs;
}

struct WeightedSum {
  dvec3 sum{0, 0, 0};
  double weight = 0;
  dvec3 direction() const {
    return glm::length(sum) > kOpposed * weight ? direction_or_zero(sum) : dvec3(0.0);
  }
};

/// Of each group, by sign: 1, then -1.
using Sums = std::vector<std::array<WeightedSum, 2>>;

void add_triangle(const Mesh& mesh, const Corners& corner, const std::vector<dvec3>& places,
                  const std::vector<dvec3>& normals, const std::vector<int>& groups, Sums& sums) {
  const CoordinateEdges edges = edges_of(mesh, corner);
  const int sign = edges.sign();
  if (sign == 0) return;
  const dvec3 e1 = places[corner[1]] - places[corner[0]], e2 = places[corner[2]] - places[corner[0]];
  const dvec3 along_u = -static_cast<double>(sign) * (edges.two.y * e1 - edges.one.y * e2);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t own = corner[k], next = corner[(k + 1) % 3], last = corner[(k + 2) % 3];
    const dvec3& normal = normals[own];
    const dvec3 one = in_plane(places[next] - places[own], normal),
                two = in_plane(places[last] - places[own], normal);
    const double angle = std::atan2(glm::length(glm::cross(one, two)), glm::dot(one, two));
    WeightedSum& sum = sums[groups[own]][sign > 0 ? 0 : 1];
    sum.sum += angle * in_plane(along_u, normal);
    sum.weight += angle;
  }
}

/// The tangent of each vertex where the surface has these places and normals.
std::vector<dvec3> tangents_at(const Mesh& mesh, const std::vector<dvec3>& places,
                               const std::vector<dvec3>& normals, const std::vector<int>& groups,
                               std::vector<int>& signs) {
  Sums sums(groups.size());
  for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t)
    add_triangle(mesh, corners_of(mesh, t), places, normals, groups, sums);
  std::vector<dvec3> tangents;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto& [plus, minus] = sums[groups[i]];
    // A vertex of triangles without area takes what others at its place have.
    if (signs[i] == 0) signs[i] = plus.weight > 0 ? 1 : minus.weight > 0 ? -1 : 0;
    tangents.push_back(signs[i] == 0 ? dvec3(0.0) : (signs[i] > 0 ? plus : minus).direction());
  }
  return tangents;
}

/// `own` and what a target at weight 1 adds.
std::vector<dvec3> moved(const std::vector<vec3>& own, const std::vector<vec3>& added) {
  std::vector<dvec3> sum(own.begin(), own.end());
  for (std::size_t i = 0; i < added.size(); ++i) sum[i] += dvec3(added[i]);
  return sum;
}

int triangles_without_tangents(const Mesh& mesh) {
  int count = 0;
  for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    count += mesh.tangents[a].w == 0 && mesh.tangents[b].w == 0 && mesh.tangents[c].w == 0;
  }
  return count;
}

}  // namespace

int derive_tangents(Mesh& mesh) {
  TALISMAN_CHECK_EQ(mesh.normals.size(), mesh.positions.size());
  TALISMAN_CHECK_EQ(coordinates_of(mesh).size(), mesh.positions.size());
  mesh.tangents.clear();
  for (MorphTarget& morph : mesh.morphs) morph.tangents.clear();
  std::vector<int> groups = groups_of(mesh), signs = split_by_sign(mesh, groups);
  const std::vector<dvec3> places = moved(mesh.positions, {}), normals = moved(mesh.normals, {}),
                           at_rest = tangents_at(mesh, places, normals, groups, signs);
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    const vec3 tangent(at_rest[i]);
    mesh.tangents.emplace_back(tangent, tangent == vec3(0) ? 0 : signs[i]);
  }
  for (MorphTarget& morph : mesh.morphs) {
    std::vector<dvec3> turned = moved(mesh.normals, morph.normals);
    for (dvec3& normal : turned) normal = direction_or_zero(normal);
    const std::vector<dvec3> tangents =
        tangents_at(mesh, moved(mesh.positions, morph.positions), turned, groups, signs);
    for (std::size_t i = 0; i < tangents.size(); ++i)
      morph.tangents.emplace_back(tangents[i] == dvec3(0.0) ? dvec3(0.0) : tangents[i] - at_rest[i]);
  }
  return triangles_without_tangents(mesh);
}

void make_flat_normals(Mesh& mesh) {
  const std::size_t old_vertices = mesh.positions.size();
  for (const std::uint32_t index : std::vector(mesh.indices)) copy_vertex(mesh, index);
  const auto drop_old = [old_vertices](auto& values) {
    if (!values.empty())
      values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(old_vertices));
  };
  drop_old(mesh.positions), drop_old(mesh.uvs), drop_old(mesh.emissive_uvs), drop_old(mesh.normal_uvs);
  drop_old(mesh.colors), drop_old(mesh.alphas), drop_old(mesh.joints), drop_old(mesh.weights);
  for (MorphTarget& morph : mesh.morphs) drop_old(morph.positions);
  mesh.normals.clear(), mesh.tangents.clear();
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
    const dvec3 a(mesh.positions[i]), b(mesh.positions[i + 1]), c(mesh.positions[i + 2]);
    const vec3 normal(direction_or_zero(glm::cross(b - a, c - a)));
    mesh.normals.insert(mesh.normals.end(), 3, normal);
  }
}

}  // namespace talisman::layers
