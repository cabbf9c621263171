// SPDX-License-Identifier: Apache-2.0
// One part made into several: nothing is lost, doubled or moved.
#include "layers/cut.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/layer.h"
#include "layers/seam.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A strip of `quads` squares of 1 m along x, each of two triangles, its vertices shared, with all that a rigid mesh can have.
Mesh strip(int quads) {
  Mesh mesh;
  for (int x = 0; x <= quads; ++x)
    for (const int y : {0, 1}) {
      const auto at = static_cast<float>(x);
      mesh.positions.emplace_back(at, y, 0);
      mesh.normals.emplace_back(0, 0, 1);
      mesh.uvs.emplace_back(at, y);
      mesh.tangents.emplace_back(1, 0, 0, 1);
      mesh.colors.emplace_back(at / 100, y, 0.5F);
      mesh.alphas.push_back(1 - at / 100);
    }
  for (std::uint32_t q = 0; q < static_cast<std::uint32_t>(quads); ++q)
    for (const std::uint32_t v : {0U, 2U, 3U, 0U, 3U, 1U}) mesh.indices.push_back(2 * q + v);
  return mesh;
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes = {std::move(mesh)};
  scene.materials.resize(1);
  scene.nodes.resize(1);
  scene.nodes[0].name = "room";
  scene.parts = {{"room", 0, 0, 0, -1}, {"other", 0, 0, 0, -1}};
  return scene;
}

using Corner = std::array<float, 9>;  // position, uv, tangent's x, colour's r, alpha, normal's z
using Triangle = std::array<Corner, 3>;

std::vector<Triangle> triangles_of(const Scene& scene, const std::string& name) {
  std::vector<Triangle> found;
  for (const Part& part : scene.parts) {
    if (part.name.rfind(name, 0) != 0) continue;
    const Mesh& mesh = scene.meshes[part.mesh];
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      Triangle triangle;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.indices[3 * t + k];
        triangle[k] = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z,
                       mesh.uvs[v].x,       mesh.uvs[v].y,       mesh.tangents[v].x,
                       mesh.colors[v].x,    mesh.alphas[v],      mesh.normals[v].z};
      }
      found.push_back(triangle);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Part& part : scene.parts) names.push_back(part.name);
  return names;
}

TEST(Cut, TrianglesStayWhatTheyAre) {
  const Scene before = scene_of(strip(13));
  for (const int pieces : {2, 3, 5, 8, 26}) {
    Scene scene = before;
    EXPECT_EQ(cut_part(scene, 0, pieces), pieces);
    EXPECT_EQ(triangles_of(scene, "room"), triangles_of(before, "room")) << pieces;
    EXPECT_EQ(triangles_of(scene, "other"), triangles_of(before, "other")) << "which has the same mesh";
  }
}

TEST(Cut, TheLongestPieceInItsMiddle) {
  Scene scene = scene_of(strip(16));
  ASSERT_EQ(cut_part(scene, 0, 3), 3);
  EXPECT_THAT(names_of(scene), ElementsAre("room~1", "other", "room~2", "room~3"));
  std::vector<std::array<float, 3>> found;  // triangles, from, to
  for (const Part& part : scene.parts) {
    if (part.name == "other") continue;
    const Mesh& mesh = scene.meshes[part.mesh];
    float lo = 1e9F, hi = -1e9F;
    for (const vec3& p : mesh.positions) lo = std::min(lo, p.x), hi = std::max(hi, p.x);
    found.push_back({static_cast<float>(mesh.triangle_count()), lo, hi});
    EXPECT_EQ(mesh.positions.size(), static_cast<std::size_t>(mesh.triangle_count()) + 2)
        << "no vertex that no triangle uses";
    EXPECT_EQ(mesh.alphas.size(), mesh.positions.size());
  }
  EXPECT_THAT(found,
              ElementsAre(std::array{8.F, 0.F, 4.F}, std::array{16.F, 8.F, 16.F}, std::array{8.F, 4.F, 8.F}));
}

TEST(Cut, WallsThatFaceEachOtherAreApart) {
  Scene scene = scene_of(tests::cube_mesh(2));
  ASSERT_EQ(cut_part(scene, 0, 6), 6);
  for (const Part& part : scene.parts) {
    if (part.name == "other") continue;
    const Mesh& mesh = scene.meshes[part.mesh];
    EXPECT_EQ(mesh.triangle_count(), 2) << part.name;
    for (const vec3& normal : mesh.normals) EXPECT_EQ(normal, mesh.normals.front()) << part.name;
  }
}

TEST(Cut, NoMorePiecesThanTriangles) {
  Scene scene = scene_of(strip(1));
  EXPECT_EQ(cut_part(scene, 0, 8), 2);
  EXPECT_EQ(cut_part(scene, 0, 8), 1) << "one triangle";
  EXPECT_EQ(names_of(scene).front(), "room~1");
  Scene many = scene_of(strip(200));
  EXPECT_EQ(cut_part(many, 0, 1'000'000'000), kMostCutPieces);
  Scene none = scene_of({});
  EXPECT_EQ(cut_part(none, 0, 4), 1);
  EXPECT_EQ(cut_part(none, 0, 0), 1);
  EXPECT_THAT(names_of(none), ElementsAre("room", "other"));
}

TEST(Cut, TrianglesInOnePlaceAreDividedByNumber) {
  Mesh mesh = strip(1);
  for (int k = 0; k < 7; ++k) mesh.indices.insert(mesh.indices.end(), {0, 2, 3});
  Scene scene = scene_of(mesh), again = scene_of(mesh);
  ASSERT_EQ(cut_part(scene, 0, 4), 4);
  cut_part(again, 0, 4);
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    EXPECT_EQ(scene.meshes[scene.parts[i].mesh].indices, again.meshes[again.parts[i].mesh].indices);
  EXPECT_THAT(triangles_of(scene, "room"), testing::SizeIs(9));
}

TEST(Cut, WhatDeformsIsNotCut) {
  Scene scene = scene_of(strip(2));
  EXPECT_EQ(cut_defect(scene, 0), "");
  scene.parts[0].skin = 0;
  EXPECT_EQ(cut_defect(scene, 0), "has a skin");
  scene.parts[0].skin = -1;
  scene.meshes[0].morphs.emplace_back();
  EXPECT_EQ(cut_defect(scene, 0), "has morph targets");
}

/// Pieces meet along whole edges: seams find them.
TEST(Cut, PiecesShareTheirEdges) {
  Scene scene = scene_of(strip(4));
  scene.meshes[0].alphas.clear();  // opaque
  scene.parts.pop_back();
  ASSERT_EQ(cut_part(scene, 0, 2), 2);
  std::vector<LayerSpec> specs;
  for (const Part& part : scene.parts) {
    specs.emplace_back();
    specs.back().name = part.name;
    specs.back().part_globs = {part.name};
  }
  const std::vector<SharedEdge> edges = shared_edges(scene, factor(scene, specs));
  ASSERT_EQ(edges.size(), 2U) << "one, from both sides";
  for (const SharedEdge& edge : edges) EXPECT_EQ(edge.a.x, 2);
}

}  // namespace
}  // namespace talisman::layers
