// SPDX-License-Identifier: Apache-2.0
#include "layers/mesh_clusters.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

int triangles_in(const std::vector<MeshCluster>& clusters) {
  int sum = 0;
  for (const MeshCluster& cluster : clusters) sum += cluster.triangles;
  return sum;
}

bool contains(const MeshCluster& cluster, const vec3& p) {
  for (int k = 0; k < 3; ++k)
    if (!(p[k] >= cluster.lo[k] && p[k] <= cluster.hi[k])) return false;
  return true;
}

TEST(MeshClusters, EachTriangleIsInOneOfThemAndNoneHasTooMany) {
  const Mesh mesh = tests::sphere_mesh(24, 48, 1, 0.1);
  for (const int most : {1, 7, 64, 256, 100'000}) {
    const std::vector<MeshCluster> clusters = mesh_clusters(mesh, most);
    EXPECT_EQ(triangles_in(clusters), mesh.triangle_count());
    for (const MeshCluster& cluster : clusters) {
      EXPECT_LE(cluster.triangles, most);
      EXPECT_GE(cluster.triangles, 1);
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {  // all corners of a triangle are in one box
      bool held = false;
      for (const MeshCluster& cluster : clusters)
        held = held || (contains(cluster, mesh.positions[mesh.indices[i]]) &&
                        contains(cluster, mesh.positions[mesh.indices[i + 1]]) &&
                        contains(cluster, mesh.positions[mesh.indices[i + 2]]));
      EXPECT_TRUE(held);
    }
  }
}

TEST(MeshClusters, NeighboursLieTogether) {
  // 32 × 32 cells in clusters of 64: a cluster spans an eighth of the square, not all of it.
  for (const MeshCluster& cluster : mesh_clusters(tests::quad_mesh(32, 32), 64)) {
    EXPECT_LE(cluster.hi.x - cluster.lo.x, 9);
    EXPECT_LE(cluster.hi.y - cluster.lo.y, 9);
  }
}

TEST(MeshClusters, TrianglesOfOnePlaceAreStillSplit) {
  Mesh mesh;
  mesh.positions.assign(3, vec3(2, 3, 4));
  for (int i = 0; i < 100; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  EXPECT_EQ(triangles_in(mesh_clusters(mesh, 8)), 100);
}

TEST(MeshClusters, WhatIsNotDrawnIsInNone) {
  EXPECT_TRUE(mesh_clusters(Mesh(), 64).empty());
  Mesh mesh = tests::cube_mesh();
  mesh.positions[mesh.indices[0]].y = std::numeric_limits<float>::quiet_NaN();
  int lost = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (int k = 0; k < 3; ++k) lost += mesh.indices[i + k] == mesh.indices[0];
  EXPECT_EQ(triangles_in(mesh_clusters(mesh, 4)), 12 - lost);
}

}  // namespace
}  // namespace talisman::layers
