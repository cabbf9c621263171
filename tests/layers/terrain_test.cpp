// SPDX-License-Identifier: Apache-2.0
#include "layers/terrain.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace talisman::layers {
namespace {

HeightField waves(int columns, int rows) {
  HeightField field{columns, rows, {}, 0.7f, 1.3f};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      field.heights_m.push_back(static_cast<float>(std::sin(0.9 * column) * std::cos(0.4 * row) * 3));
  return field;
}

int rows_of(const Mesh& mesh, const HeightField& field) {
  return static_cast<int>(mesh.positions.size()) / field.columns;
}

TEST(TerrainSegments, SmallestFieldIsOneCell) {
  const auto segments = terrain_segments({2, 2, {1, 2, 3, 4}, 2, 3}, {});
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].triangle_count(), 2);
  EXPECT_EQ(segments[0].positions.front(), (vec3{-1, 1, 0}));
  EXPECT_EQ(segments[0].positions.back(), (vec3{1, 4, -3}));
  EXPECT_EQ(segments[0].uvs.front(), (vec2{0, 0}));
  EXPECT_EQ(segments[0].uvs.back(), (vec2{1, 1}));
}

TEST(TerrainSegments, CountAndLengthAreThoseAskedFor) {
  for (const int rows : {2, 100, 101, 102, 201, 202, 251})
    for (const int cells : {1, 7, 100}) {
      const auto field = waves(3, rows);
      const auto segments = terrain_segments(field, {cells, 0});
      EXPECT_EQ(static_cast<int>(segments.size()), (rows - 1 + cells - 1) / cells);
      int total = 0;
      for (const Mesh& mesh : segments) {
        EXPECT_LE(rows_of(mesh, field) - 1, cells);
        total += mesh.triangle_count();
      }
      EXPECT_EQ(total, 2 * 2 * (rows - 1)) << "without seams each cell is in one segment";
    }
}

// The seam is only invisible if what both sides share is the same to the last bit.
TEST(TerrainSegments, NeighboursShareSeamVerticesBitByBit) {
  const auto field = waves(9, 41);
  for (const int seam : {0, 1, 3}) {
    const auto segments = terrain_segments(field, {10, seam});
    ASSERT_EQ(segments.size(), 4u);
    for (std::size_t k = 0; k + 1 < segments.size(); ++k) {
      const Mesh &near = segments[k], &far = segments[k + 1];
      const std::size_t shared = static_cast<std::size_t>(seam + 1) * field.columns;
      const std::size_t first = near.positions.size() - shared;
      for (std::size_t i = 0; i < shared; ++i) {
        ASSERT_EQ(near.positions[first + i], far.positions[i]) << "seam " << seam << ", segment " << k;
        ASSERT_EQ(near.normals[first + i], far.normals[i]);
        ASSERT_EQ(near.uvs[first + i], far.uvs[i]);
      }
    }
  }
}

TEST(TerrainSegments, SeamWiderThanTheRestStopsAtTheRim) {
  const auto field = waves(4, 6);
  const auto segments = terrain_segments(field, {2, 100});
  EXPECT_EQ(rows_of(segments[0], field), 6);
  EXPECT_EQ(segments[0].positions.back(), segments.back().positions.back());
}

// 5 x 5 samples in 2 x 2 tiles without seams: each has 2 x 2 cells, 3 x 3 vertices.
TEST(TerrainSegments, TilesSideBySideShareTheirBorder) {
  const auto field = waves(5, 5);
  const auto tiles = terrain_segments(field, {.cells_per_segment = 2, .seam_cells = 0, .across = 2});
  ASSERT_EQ(tiles.size(), 4u);
  for (const Mesh& tile : tiles) {
    EXPECT_EQ(tile.positions.size(), 9u);
    EXPECT_EQ(tile.triangle_count(), 8);
  }
  for (const std::size_t row : {0, 1, 2}) {
    EXPECT_EQ(tiles[0].positions[3 * row + 2], tiles[1].positions[3 * row]);
    EXPECT_EQ(tiles[0].normals[3 * row + 2], tiles[1].normals[3 * row]);
    EXPECT_EQ(tiles[0].positions[6 + row], tiles[2].positions[row]);
  }
  EXPECT_EQ(tiles[3].uvs.front(), (vec2{0.5f, 0.5f}));
  EXPECT_EQ(tiles[3].uvs.back(), (vec2{1, 1}));
}

// With a seam of a cell the left tiles reach to column 3, those at the right rim no farther than it.
TEST(TerrainSegments, TilesReachOverTheirRightBorder) {
  const auto tiles = terrain_segments(waves(5, 5), {.cells_per_segment = 4, .seam_cells = 1, .across = 2});
  ASSERT_EQ(tiles.size(), 2u);
  EXPECT_EQ(tiles[0].positions.size(), 4u * 5);
  EXPECT_EQ(tiles[1].positions.size(), 3u * 5);
  EXPECT_FLOAT_EQ(tiles[0].uvs.back().x, 0.75f);
  EXPECT_EQ(tiles[1].uvs.back().x, 1);
}

// Seven samples, a vertex at 0, 3 and 6; eight: the rim's as well, though it is nearer.
TEST(TerrainSegments, CoarseMeshesKeepTheirRim) {
  for (const int rows : {7, 8}) {
    const auto field = waves(4, rows);
    const auto tiles = terrain_segments(field, {.seam_cells = 0, .every = 3});
    ASSERT_EQ(tiles.size(), 1u);
    ASSERT_EQ(tiles[0].positions.size(), 2u * (rows == 7 ? 3 : 4));
    EXPECT_EQ(tiles[0].positions[2], terrain_segments(field, {})[0].positions[3 * 4]);
    EXPECT_EQ(tiles[0].positions.back(), terrain_segments(field, {})[0].positions.back());
  }
}

// Borders of a coarse mesh lie on its own vertices: neighbours share them.
TEST(TerrainSegments, CoarseTilesShareTheirBorder) {
  const auto tiles =
      terrain_segments(waves(12, 12), {.cells_per_segment = 2, .seam_cells = 0, .across = 2, .every = 3});
  ASSERT_EQ(tiles.size(), 4u);
  for (const std::size_t row : {0, 1, 2})
    EXPECT_EQ(tiles[0].positions[3 * row + 2], tiles[1].positions[3 * row]);
}

TEST(TerrainSegments, TrianglesFaceUp) {
  const auto field = waves(12, 12);
  for (const Mesh& mesh : terrain_segments(field, {5, 1}))
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]];
      const vec3 face = glm::cross(b - a, mesh.positions[mesh.indices[i + 2]] - a);
      EXPECT_GT(face.y, 0);
    }
}

// On a plane every normal is known, at the rim too.
TEST(TerrainSegments, NormalsOfAPlaneAreExact) {
  HeightField field{5, 9, {}, 0.5f, 2};
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 5; ++column)
      field.heights_m.push_back(0.5f * 0.5f * static_cast<float>(column) -
                                0.25f * -2 * static_cast<float>(row));
  const vec3 expected = vec3(glm::normalize(dvec3{-0.5, 1, 0.25}));  // h = 0.5 x − 0.25 z
  for (const Mesh& mesh : terrain_segments(field, {3, 1}))
    for (const vec3& normal : mesh.normals) EXPECT_LT(glm::distance(normal, expected), 1e-6f);
}

TEST(TerrainSegments, CliffsGiveUnitNormals) {
  HeightField field = waves(6, 6);
  for (std::size_t i = 0; i < field.heights_m.size(); i += 2) field.heights_m[i] = 1e30f;
  for (const Mesh& mesh : terrain_segments(field, {}))
    for (const vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-6);
}

TEST(TerrainSegmentsDeathTest, WrongLengthIsAProgrammersMistake) {
  EXPECT_DEATH(terrain_segments({2, 2, {1, 2, 3}, 1, 1}, {}), "3 against 4");
}

}  // namespace
}  // namespace talisman::layers
