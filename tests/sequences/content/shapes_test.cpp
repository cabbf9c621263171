// SPDX-License-Identifier: Apache-2.0
// Shapes of a sequence file: closed, right side out, where the file puts them; what is wrong is refused with
// its line.
#include "sequences/content/shapes.h"

#include <array>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/content/sequence.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;
using Kind = ShapeContent::Kind;

ShapeContent shape(Kind kind, dvec3 size, int segments, double taper = 1) {
  ShapeContent s;
  s.kind = kind;
  s.size_m = size;
  s.segments = segments;
  s.taper = taper;
  return s;
}

/// Coarse, fine, squashed and pointed.
std::vector<ShapeContent> closed_shapes() {
  return {shape(Kind::Box, {1, 2, 3}, 1),         shape(Kind::Box, {1e-4, 1e4, 0.3}, 7),
          shape(Kind::Sphere, {2, 2, 2}, 32),     shape(Kind::Sphere, {1, 5, 0.2}, 3),
          shape(Kind::Cylinder, {2, 3, 2}, 32),   shape(Kind::Cylinder, {2, 3, 2}, 3, 0.4),
          shape(Kind::Cylinder, {2, 3, 2}, 17, 0)};
}

using Point = std::array<float, 3>;
Point key(const layers::vec3& p) { return {p.x, p.y, p.z}; }

TEST(ShapeMesh, EveryEdgeIsSharedByTwoTrianglesInOppositeDirections) {
  // By position, bit for bit: the seam of a sphere, the rim of a cylinder and the edges of a box have
  // vertices of their own on both sides.
  for (const ShapeContent& s : closed_shapes()) {
    const layers::Mesh mesh = shape_mesh(s);
    std::map<std::pair<Point, Point>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      for (int k = 0; k < 3; ++k) {
        const Point a = key(mesh.positions[mesh.indices[i + k]]);
        const Point b = key(mesh.positions[mesh.indices[i + (k + 1) % 3]]);
        ASSERT_NE(a, b) << "a triangle without area";
        ++edges[{a, b}];
      }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
  }
}

TEST(ShapeMesh, TrianglesAndNormalsFaceOutwards) {
  // Every shape is convex around its origin, so the origin is behind every triangle.
  for (const ShapeContent& s : closed_shapes()) {
    const layers::Mesh mesh = shape_mesh(s);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
          c(mesh.positions[mesh.indices[i + 2]]);
      ASSERT_GT(glm::dot(glm::cross(b - a, c - a), a), 0);
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
      ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-6);
      ASSERT_GT(glm::dot(mesh.normals[i], mesh.positions[i]), 0);
    }
  }
}

TEST(ShapeMesh, FillsItsSize) {
  for (const ShapeContent& s : closed_shapes()) {
    dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
    for (const layers::vec3& p : shape_mesh(s).positions) {
      lo = glm::min(lo, dvec3(p));
      hi = glm::max(hi, dvec3(p));
    }
    EXPECT_NEAR(hi.y - lo.y, s.size_m.y, 1e-6 * s.size_m.y);
    EXPECT_LE(hi.x - lo.x, s.size_m.x * (1 + 1e-6));
    EXPECT_GE(hi.z - lo.z, 0.7 * s.size_m.z);  // three segments around do not reach all sides
  }
}

TEST(ShapeMesh, PlaneIsFlatAndFacesUp) {
  const layers::Mesh mesh = shape_mesh(shape(Kind::Plane, {4, 1, 2}, 3));
  EXPECT_EQ(mesh.triangle_count(), 18);
  for (const layers::vec3& n : mesh.normals) EXPECT_EQ(n, layers::vec3(0, 1, 0));
  const dvec3 a(mesh.positions[mesh.indices[0]]), b(mesh.positions[mesh.indices[1]]),
      c(mesh.positions[mesh.indices[2]]);
  EXPECT_GT(glm::cross(b - a, c - a).y, 0);
  EXPECT_EQ(mesh.uvs.front(), layers::vec2(0, 1));  // the corner at -x and +z: below left in the texture
  EXPECT_EQ(mesh.positions.front(), layers::vec3(-2, 0, 1));
}

// --- In a sequence file ---

std::string file_with(const std::string& shapes) { return "frames: 4\nfps: 1\nshapes:\n" + shapes; }

Sequence load(const std::string& shapes) {
  const TemporaryFolder folder;
  return load_sequence(folder.write("test.yaml", file_with(shapes)));
}

std::string shape_error(const std::string& shapes) {
  return message_of([&] { load(shapes); });
}

TEST(ShapeMesh, DiscIsFlatFacesUpAndHasTheAreaOfItsPolygon) {
  const layers::Mesh mesh = shape_mesh(shape(Kind::Disc, {4, 1, 4}, 6));
  EXPECT_EQ(mesh.triangle_count(), 4);
  for (const layers::vec3& n : mesh.normals) EXPECT_EQ(n, layers::vec3(0, 1, 0));
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
        c(mesh.positions[mesh.indices[i + 2]]);
    const dvec3 across = glm::cross(b - a, c - a);
    EXPECT_GT(across.y, 0);
    area += 0.5 * glm::length(across);
  }
  EXPECT_NEAR(area, 6 * std::sqrt(3), 1e-5);          // a hexagon of radius 2: 3/2 · √3 · 2²
  EXPECT_EQ(mesh.uvs.front(), layers::vec2(0.5, 1));  // at +z: below in the texture, as on a plane
}

TEST(LoadSequence, ShapesBecomePartsOfTheirNames) {
  const Sequence s = load(
      "  - {id: a, box: [1, 2, 3], color: [0.1, 0.2, 0.3], opacity: 0.5, two_sided: true}\n"
      "  - id: b\n"
      "    sphere: 2\n"
      "    segments: 8\n"
      "    instances: [{name: one, position: [0, 5, 0]}, {name: two, position: [0, 9, 0]}]\n");
  ASSERT_EQ(s.scene->parts.size(), 3u);
  EXPECT_EQ(s.scene->parts[0].name, "a");
  EXPECT_EQ(s.scene->parts[1].name, "one");
  EXPECT_EQ(s.scene->parts[2].name, "two");
  EXPECT_EQ(s.scene->parts[1].mesh, s.scene->parts[2].mesh);
  EXPECT_EQ(s.scene->meshes.size(), 2u);
  EXPECT_EQ(s.scene->materials[0].base_color, layers::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(s.scene->materials[0].opacity, 0.5f);
  EXPECT_TRUE(s.scene->materials[0].two_sided);
}

TEST(LoadSequence, CarriedShapesMoveWithTheirCarrier) {
  const Sequence s = load(
      "  - {id: disc, cylinder: [8, 0.2], position: [0, 1, 0], spin: {axis: [0, 1, 0], deg_per_s: 90}}\n"
      "  - {id: arm, box: [1, 1, 1], position: [3, 0, 0], carried_by: disc}\n"
      "  - {id: hand, box: [1, 1, 1], position: [0, 2, 0], carried_by: arm}\n");
  const layers::SceneFrame frame = s.scene->at(1);  // a quarter turn: +x goes to -z
  const dvec3 hand(frame.world_from_node[s.scene->parts[2].node][3]);
  EXPECT_NEAR(glm::distance(hand, dvec3(0, 3, -3)), 0, 1e-12);
}

TEST(LoadSequence, WrongShapesAreRefusedWithTheirLine) {
  EXPECT_THAT(shape_error("  - {id: a}\n"), HasSubstr("test.yaml:4: shapes[0]"));
  EXPECT_THAT(shape_error("  - {id: a}\n"), HasSubstr("box, sphere, cylinder, plane and disc"));
  EXPECT_THAT(shape_error("  - {id: a, box: [1, 1, 1], sphere: 2}\n"), HasSubstr("not two"));
  EXPECT_THAT(shape_error("  - {id: a, box: [1, 0, 1]}\n"), HasSubstr("each from 1e-09 to 1e+09"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: -1}\n"), HasSubstr("shapes[0].sphere"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1, segments: 2}\n"), HasSubstr("segments"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1, taper: 0.5}\n"), HasSubstr("only together with cylinder"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1, radius: 2}\n"), HasSubstr("radius"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1}\n  - {id: a, sphere: 2}\n"),
              HasSubstr("test.yaml:5: two shapes are called 'a'"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1, carried_by: b}\n  - {id: b, sphere: 2}\n"),
              HasSubstr("test.yaml:4: carried_by is 'b'"));
  EXPECT_THAT(shape_error("  - {id: a, sphere: 1, carried_by: a}\n"), HasSubstr("carried_by is 'a'"));
}

}  // namespace
}  // namespace talisman::sequences
