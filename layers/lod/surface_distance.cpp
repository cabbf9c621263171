// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "layers/lod/triangle_tree.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr int kAtRest = -1;

std::vector<dvec3> posed(const Mesh& mesh, int target) {
  std::vector<dvec3> positions(mesh.positions.begin(), mesh.positions.end());
  if (target == kAtRest || static_cast<std::size_t>(target) >= mesh.morphs.size()) return positions;
  const auto& offsets = mesh.morphs[static_cast<std::size_t>(target)].positions;
  for (std::size_t v = 0; v < std::min(positions.size(), offsets.size()); ++v)
    positions[v] += dvec3(offsets[v]);
  return positions;
}

struct SamplePlace {
  dvec3 position{0}, normal{0};
};

/// The twice-area vector of a triangle.
dvec3 area_vector(const std::vector<dvec3>& at, const Mesh& mesh, std::size_t triangle) {
  const dvec3& a = at[mesh.indices[3 * triangle]];
  return glm::cross(at[mesh.indices[3 * triangle + 1]] - a, at[mesh.indices[3 * triangle + 2]] - a);
}

/// Places spread evenly over the area.
std::vector<SamplePlace> spread_places(const std::vector<dvec3>& at, const Mesh& mesh) {
  const std::size_t triangles = mesh.indices.size() / 3;
  double total = 0;
  for (std::size_t i = 0; i < triangles; ++i) total += glm::length(area_vector(at, mesh, i));
  std::vector<SamplePlace> places;
  if (!(total > 0) || !std::isfinite(total)) return places;
  const auto count = std::clamp<std::size_t>(4 * triangles, kLeastSurfaceSamples, kMostSurfaceSamples);
  const double step = total / static_cast<double>(count);
  // The reciprocals of the plastic number and of its square.
  double u = 0.5, v = 0.5, next = 0.5 * step, reached = 0;
  for (std::size_t i = 0; i < triangles; ++i) {
    const dvec3 area = area_vector(at, mesh, i);
    reached += glm::length(area);
    for (; next < reached; next += step) {
      u += 0.7548776662466927, v += 0.5698402909980532;
      u -= std::floor(u), v -= std::floor(v);
      const bool folded = u + v > 1;
      const double s = folded ? 1 - u : u, t = folded ? 1 - v : v;
      const dvec3 &a = at[mesh.indices[3 * i]], &b = at[mesh.indices[3 * i + 1]],
                  &c = at[mesh.indices[3 * i + 2]];
      places.push_back({a + s * (b - a) + t * (c - a), direction_or_zero(area)});
    }
  }
  return places;
}

/// Largest distance from the surface of `mesh` to `other`.
double one_sided(const std::vector<dvec3>& at, const Mesh& mesh, const std::vector<SamplePlace>& places,
                 const TriangleTree& other) {
  double largest = 0;
  std::vector<bool> used(at.size(), false);
  for (const std::uint32_t v : mesh.indices) used[v] = true;
  const std::size_t stride = at.size() / kMostSurfaceSamples + 1;
  for (std::size_t v = 0; v < at.size(); v += stride)
    if (used[v]) largest = std::max(largest, other.distance(at[v]));
  for (const SamplePlace& place : places) largest = std::max(largest, other.distance(place.position));
  return largest;
}

/// Surfaces that lie on each other (the two sides of a sheet) are all beside a place: the one that looks its way is meant.
double mean_facing(const std::vector<SamplePlace>& places, const TriangleTree& base, double slack_m) {
  double sum = 0;
  for (const SamplePlace& place : places) {
    const double within_m = base.distance(place.position) + slack_m;
    sum += std::max(-1.0, base.best_facing(place.position, within_m, place.normal));
  }
  return places.empty() ? 1 : sum / static_cast<double>(places.size());
}

double diagonal(const std::vector<dvec3>& at) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const dvec3& p : at) lo = glm::min(lo, p), hi = glm::max(hi, p);
  return at.empty() ? 0 : glm::length(hi - lo);
}

SurfaceDistance distance_in_pose(const Mesh& base, const Mesh& level, int target) {
  const std::vector<dvec3> base_at = posed(base, target), level_at = posed(level, target);
  const TriangleTree base_tree(base_at, base.indices), level_tree(level_at, level.indices);
  const auto base_places = spread_places(base_at, base), level_places = spread_places(level_at, level);
  SurfaceDistance result;
  result.from_base_m = one_sided(base_at, base, base_places, level_tree);
  result.from_level_m = one_sided(level_at, level, level_places, base_tree);
  result.facing = mean_facing(level_places, base_tree, 1e-6 * diagonal(base_at));
  return result;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& base, const Mesh& level) {
  if (base.indices.size() < 3 || level.indices.size() < 3) return {HUGE_VAL, HUGE_VAL, 0};
  SurfaceDistance result = distance_in_pose(base, level, kAtRest);
  for (int target = 0; target < static_cast<int>(base.morphs.size()); ++target) {
    const SurfaceDistance posed = distance_in_pose(base, level, target);
    result.from_base_m = std::max(result.from_base_m, posed.from_base_m);
    result.from_level_m = std::max(result.from_level_m, posed.from_level_m);
  }
  return result;
}

}  // namespace talisman::layers
