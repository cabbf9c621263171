// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/shapes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::sequences {

namespace {

using layers::dvec2;
using layers::dvec3;
using layers::Mesh;

void add_vertex(Mesh& mesh, const dvec3& position, const dvec3& normal, const dvec2& uv) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(glm::normalize(normal));
  mesh.uvs.emplace_back(uv);
}

/// Rows of vertices are joined by quads; row r is at first + r · (columns + 1). Seen from outside, the next
/// row lies to the left of the way along a row. The triangles without area at poles and tips are left out.
void add_quads(Mesh& mesh, int first, int columns, int rows, bool pole_first = false,
               bool pole_last = false) {
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const std::uint32_t a = first + r * (columns + 1) + c, b = a + 1;
      const std::uint32_t d = a + columns + 1, e = d + 1;
      if (!(pole_first && r == 0)) mesh.indices.insert(mesh.indices.end(), {a, b, d});
      if (!(pole_last && r == rows - 1)) mesh.indices.insert(mesh.indices.end(), {b, e, d});
    }
}

/// A rectangle of cells: from `corner` along u and v; u × v points outwards. Corners of neighbouring faces
/// are computed by the same products, so that they have the same bits.
void add_face(Mesh& mesh, const dvec3& center, const dvec3& u, const dvec3& v, int cells) {
  const int first = static_cast<int>(mesh.positions.size());
  for (int r = 0; r <= cells; ++r)
    for (int c = 0; c <= cells; ++c) {
      const dvec2 st(static_cast<double>(c) / cells, static_cast<double>(r) / cells);
      add_vertex(mesh, center + (st.x - 0.5) * u + (st.y - 0.5) * v, glm::cross(u, v), {st.x, 1 - st.y});
    }
  add_quads(mesh, first, cells, cells);
}

void add_box(Mesh& mesh, const dvec3& size, int cells) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 normal(0), u(0), v(0);
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      normal[axis] = 0.5 * side * size[axis];
      u[side > 0 ? next : last] = size[side > 0 ? next : last];
      v[side > 0 ? last : next] = size[side > 0 ? last : next];
      add_face(mesh, normal, u, v, cells);
    }
}

/// Direction number k of n around y, from +z towards +x; the last is the first, bit by bit.
dvec2 around(int k, int n) {
  const double angle = 2 * M_PI * (k % n) / n;
  return {std::sin(angle), std::cos(angle)};
}

/// Height and radius of parallel r of `rows` on the unit sphere, from the south pole; exact at both poles.
dvec2 parallel(int r, int rows) {
  if (r == 0 || r == rows) return {r == 0 ? -1 : 1, 0};
  const double angle = M_PI * r / rows;
  return {-std::cos(angle), std::sin(angle)};
}

void add_sphere(Mesh& mesh, const dvec3& size, int segments) {
  const int rows = std::max(2, segments / 2);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= segments; ++c) {
      const dvec2 height = parallel(r, rows), a = around(c, segments);
      const dvec3 unit(a.x * height.y, height.x, a.y * height.y);
      add_vertex(mesh, 0.5 * size * unit, unit / size,
                 {static_cast<double>(c) / segments, 1 - static_cast<double>(r) / rows});
    }
  add_quads(mesh, 0, segments, rows, true, true);
}

void add_mantle(Mesh& mesh, const dvec3& size, double taper, int segments) {
  for (int r = 0; r <= 1; ++r)
    for (int c = 0; c <= segments; ++c) {
      const dvec2 a = around(c, segments);
      const double share = r == 0 ? 1 : taper;
      const dvec3 outwards(a.x / size.x, 0.5 * (1 - taper) / size.y, a.y / size.z);
      add_vertex(mesh, {0.5 * size.x * share * a.x, (r - 0.5) * size.y, 0.5 * size.z * share * a.y}, outwards,
                 {static_cast<double>(c) / segments, 1.0 - r});
    }
  add_quads(mesh, 0, segments, 1, false, taper == 0);
}

/// A fan around the middle of the bottom (side -1) or top (+1).
void add_cap(Mesh& mesh, const dvec3& size, double share, double side, int segments) {
  const std::uint32_t middle = static_cast<std::uint32_t>(mesh.positions.size());
  const double y = 0.5 * side * size.y;
  const dvec3 normal(0, side, 0);
  add_vertex(mesh, {0, y, 0}, normal, {0.5, 0.5});
  for (int c = 0; c < segments; ++c) {
    const dvec2 a = around(c, segments);
    add_vertex(mesh, {0.5 * size.x * share * a.x, y, 0.5 * size.z * share * a.y}, normal,
               0.5 + 0.5 * dvec2(a.x, -side * a.y));
    const std::uint32_t one = middle + 1 + c, next = middle + 1 + (c + 1) % segments;
    if (side > 0)
      mesh.indices.insert(mesh.indices.end(), {middle, one, next});
    else
      mesh.indices.insert(mesh.indices.end(), {middle, next, one});
  }
}

/// A fan from the first corner, and no vertex in the middle: a disc of n corners has n - 2 triangles.
void add_disc(Mesh& mesh, const dvec3& size, int segments) {
  for (int c = 0; c < segments; ++c) {
    const dvec2 a = around(c, segments);
    add_vertex(mesh, {0.5 * size.x * a.x, 0, 0.5 * size.z * a.y}, {0, 1, 0}, 0.5 + 0.5 * a);
    if (c >= 2)
      mesh.indices.insert(mesh.indices.end(), {0u, static_cast<unsigned>(c - 1), static_cast<unsigned>(c)});
  }
}

}  // namespace

layers::Mesh shape_mesh(const ShapeContent& shape) {
  Mesh mesh;
  switch (shape.kind) {
    case ShapeContent::Kind::Box:
      add_box(mesh, shape.size_m, shape.segments);
      break;
    case ShapeContent::Kind::Sphere:
      add_sphere(mesh, shape.size_m, shape.segments);
      break;
    case ShapeContent::Kind::Cylinder:
      add_mantle(mesh, shape.size_m, shape.taper, shape.segments);
      add_cap(mesh, shape.size_m, 1, -1, shape.segments);
      if (shape.taper > 0) add_cap(mesh, shape.size_m, shape.taper, 1, shape.segments);
      break;
    case ShapeContent::Kind::Plane:
      add_face(mesh, dvec3(0), {shape.size_m.x, 0, 0}, {0, 0, -shape.size_m.z}, shape.segments);
      break;
    case ShapeContent::Kind::Disc:
      add_disc(mesh, shape.size_m, shape.segments);
      break;
  }
  return mesh;
}

}  // namespace talisman::sequences
