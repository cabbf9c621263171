// SPDX-License-Identifier: Apache-2.0
#include "layers/mesh_clusters.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>

#include "layers/check.h"

namespace talisman::layers {
namespace {

/// A triangle as clusters see it.
struct ClusterTriangle {
  int index;
  dvec3 lo, hi;
  dvec3 middle() const { return 0.5 * (lo + hi); }
};

std::vector<ClusterTriangle> finite_triangles(const Mesh& mesh) {
  std::vector<ClusterTriangle> triangles;
  triangles.reserve(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
        c(mesh.positions[mesh.indices[i + 2]]);
    const dvec3 sum = a + b + c;
    if (!std::isfinite(sum.x + sum.y + sum.z)) continue;
    triangles.push_back({static_cast<int>(i / 3), glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  }
  return triangles;
}

int widest_axis(std::span<const ClusterTriangle> triangles) {
  dvec3 lo = triangles[0].middle(), hi = lo;
  for (const ClusterTriangle& t : triangles) {
    lo = glm::min(lo, t.middle());
    hi = glm::max(hi, t.middle());
  }
  const dvec3 width = hi - lo;
  return width.x >= width.y && width.x >= width.z ? 0 : width.y >= width.z ? 1 : 2;
}

/// Calls visit(triangles) for each cluster.
template <typename Visit>
void split(std::span<ClusterTriangle> triangles, std::size_t most, const Visit& visit) {
  if (triangles.size() <= most) return visit(triangles);
  const int axis = widest_axis(triangles);
  // In their order where they tie: where a median would fall is then for no library to choose.
  std::stable_sort(triangles.begin(), triangles.end(), [axis](const auto& a, const auto& b) {
    return a.lo[axis] + a.hi[axis] < b.lo[axis] + b.hi[axis];
  });
  const std::size_t half = triangles.size() / 2;
  split(triangles.first(half), most, visit);
  split(triangles.subspan(half), most, visit);
}

template <typename Visit>
void for_each_cluster(const Mesh& mesh, int most, const Visit& visit) {
  TALISMAN_CHECK_GE(most, 1);
  std::vector<ClusterTriangle> triangles = finite_triangles(mesh);
  if (!triangles.empty()) split(std::span(triangles), static_cast<std::size_t>(most), visit);
}

}  // namespace

std::vector<std::vector<int>> triangle_groups(const Mesh& mesh, int most) {
  std::vector<std::vector<int>> groups;
  for_each_cluster(mesh, most, [&](std::span<const ClusterTriangle> triangles) {
    std::vector<int>& group = groups.emplace_back();
    for (const ClusterTriangle& t : triangles) group.push_back(t.index);
  });
  return groups;
}

std::vector<MeshCluster> mesh_clusters(const Mesh& mesh, int most) {
  std::vector<MeshCluster> clusters;
  for_each_cluster(mesh, most, [&](std::span<const ClusterTriangle> triangles) {
    MeshCluster cluster{triangles[0].lo, triangles[0].hi, static_cast<int>(triangles.size())};
    for (const ClusterTriangle& t : triangles) {
      cluster.lo = glm::min(cluster.lo, t.lo);
      cluster.hi = glm::max(cluster.hi, t.hi);
    }
    clusters.push_back(cluster);
  });
  return clusters;
}

}  // namespace talisman::layers
