// SPDX-License-Identifier: Apache-2.0
#include "layers/tangents.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using testing::HasSubstr;

/// What the header says of a tangent and its sign, by differences along the surface: u grows along the tangent, v
/// shrinks along the bitangent.
void expect_frames_follow_coordinates(const Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
    const vec2 d1 = mesh.uvs[b] - mesh.uvs[a], d2 = mesh.uvs[c] - mesh.uvs[a];
    for (const std::uint32_t v : {a, b, c}) {
      const vec3 tangent(mesh.tangents[v]),
          bitangent = mesh.tangents[v].w * glm::cross(mesh.normals[v], tangent);
      // Gradients of u and v in the triangle's plane, by the reciprocal basis of its edges.
      const vec3 n = glm::cross(e1, e2);
      const vec3 f1 = glm::cross(e2, n) / glm::dot(n, n), f2 = glm::cross(n, e1) / glm::dot(n, n);
      EXPECT_GT(glm::dot(d1.x * f1 + d2.x * f2, tangent), 0) << "vertex " << v;
      EXPECT_LT(glm::dot(d1.y * f1 + d2.y * f2, bitangent), 0) << "vertex " << v;
    }
  }
}

Mesh half_mirrored() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {1, 1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  return mesh;
}

TEST(Tangents, OfASquareAreItsAxes) {
  Mesh mesh = tests::quad_mesh(2, 3);
  EXPECT_EQ(derive_tangents(mesh), 0);
  for (const vec4& tangent : mesh.tangents) EXPECT_LT(glm::length(tangent - vec4(1, 0, 0, 1)), 1e-6f);
}

TEST(Tangents, OfCubeAndSphereFollowTheCoordinates) {
  for (Mesh mesh : {tests::cube_mesh(), tests::sphere_mesh(8, 12), half_mirrored()}) {
    derive_tangents(mesh);
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
      if (mesh.tangents[i].w == 0) continue;
      EXPECT_NEAR(glm::length(vec3(mesh.tangents[i])), 1, 1e-6);
      EXPECT_NEAR(glm::dot(vec3(mesh.tangents[i]), mesh.normals[i]), 0, 1e-6);
    }
  }
  Mesh cube = tests::cube_mesh(), halves = half_mirrored();
  derive_tangents(cube);
  derive_tangents(halves);
  expect_frames_follow_coordinates(cube);
  expect_frames_follow_coordinates(halves);
}

TEST(Tangents, VerticesBetweenPictureAndItsMirrorImageBecomeTwo) {
  Mesh mesh = half_mirrored();
  mesh.colors.assign(6, vec3(0.5f));
  mesh.morphs.push_back({{6, vec3(0, 0, 1)}, {}, {}});
  EXPECT_EQ(derive_tangents(mesh), 0);
  Scene scene;
  scene.meshes = {mesh};
  EXPECT_EQ(first_defect(scene), "");
  ASSERT_EQ(mesh.positions.size(), 8u);
  EXPECT_EQ(mesh.colors.size(), 8u);
  EXPECT_EQ(mesh.morphs[0].positions.size(), 8u);
  for (std::size_t i = 0; i < 12; ++i) {
    const vec4& tangent = mesh.tangents[mesh.indices[i]];
    const float left = i < 6 ? 1.0f : -1.0f;
    EXPECT_EQ(tangent, vec4(left, 0, 0, left)) << "corner " << i;
  }
}

// Two triangles that lie in one plane with corners of their own are one surface; at their common edge the tangent is
// the mean by angle: 90° of (1, 0) and 45° of where u grows in the other.
TEST(Tangents, CornersOfTheSamePlaceAreAveragedByAngle) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, -1}, {0, 0}, {0, -1}, {-1, 0}};
  mesh.indices = {0, 1, 2, 3, 4, 5};
  EXPECT_EQ(derive_tangents(mesh), 0);
  // In the second: p(0, -1) = (0, 1), p(-1, 0) = (-1, 1), so along u (1, -1) / √2.
  const double right_angle = 2, half_angle = 1;
  const vec3 mean =
      glm::normalize(vec3(right_angle * dvec3(1, 0, 0) + half_angle * glm::normalize(dvec3(1, -1, 0))));
  for (const int corner : {0, 3}) {
    EXPECT_NEAR(mesh.tangents[corner].x, mean.x, 1e-6);
    EXPECT_NEAR(mesh.tangents[corner].y, mean.y, 1e-6);
  }
}

TEST(Tangents, WhereCoordinatesHaveNoAreaThereIsNone) {
  Mesh mesh = tests::quad_mesh(2, 1);
  mesh.uvs.assign(mesh.uvs.size(), {0.3f, 0.7f});
  EXPECT_EQ(derive_tangents(mesh), 2);
  for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, vec4(0));
  Scene scene;
  scene.meshes = {mesh};
  EXPECT_EQ(first_defect(scene), "");
}

TEST(Tangents, OfATriangleWithoutAreaAreNoNumbersNowhere) {
  Mesh mesh = tests::quad_mesh(2, 1);
  mesh.positions.assign(mesh.positions.size(), {1, 2, 3});
  EXPECT_EQ(derive_tangents(mesh), 2);
  for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, vec4(0));
}

TEST(Tangents, MorphTargetsAddTheDifferenceThatTheyMake) {
  Mesh mesh = tests::quad_mesh(2, 1);
  MorphTarget turn;  // by 90°: (x, y) to (-y, x)
  for (const vec3& p : mesh.positions) turn.positions.push_back(vec3(-p.y, p.x, 0) - p);
  mesh.morphs = {turn};
  derive_tangents(mesh);
  for (const vec3& added : mesh.morphs[0].tangents) EXPECT_LT(glm::length(added - vec3(-1, 1, 0)), 1e-6f);
}

TEST(FlatNormals, GiveEachTriangleCornersOfItsOwn) {
  Mesh mesh = tests::cube_mesh();
  const Mesh before = mesh;
  mesh.normals.clear();
  make_flat_normals(mesh);
  ASSERT_EQ(mesh.positions.size(), 36u);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(mesh.positions[mesh.indices[i]], before.positions[before.indices[i]]);
    EXPECT_EQ(mesh.uvs[mesh.indices[i]], before.uvs[before.indices[i]]);
    EXPECT_LT(glm::length(mesh.normals[mesh.indices[i]] - before.normals[before.indices[i]]), 1e-6f);
  }
}

TEST(TangentDefects, AreNamed) {
  Scene scene;
  scene.meshes = {tests::quad_mesh(2, 1)};
  Mesh& mesh = scene.meshes[0];
  derive_tangents(mesh);
  EXPECT_EQ(first_defect(scene), "");
  mesh.tangents[2].w = 0.5f;
  EXPECT_THAT(first_defect(scene), HasSubstr("sign of tangent 2 is 0.5, rule: 1 or -1"));
  mesh.tangents[2] = vec4(0, 0, 0, 1);
  EXPECT_THAT(first_defect(scene), HasSubstr("sign of tangent 2"));
  mesh.tangents[2] = vec4(NAN, 0, 0, 1);
  EXPECT_THAT(first_defect(scene), HasSubstr("tangent 2"));
  mesh.tangents.pop_back();
  EXPECT_THAT(first_defect(scene), HasSubstr("3 tangents, rule: none or as many as positions"));
}

}  // namespace
}  // namespace talisman::layers
