// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "layers/lod/surface_distance.h"
#include "layers/mesh_subset.h"

namespace talisman::layers {
namespace {

/// For each vertex the first one that equals it in everything.
std::vector<std::uint32_t> first_equal(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  std::size_t stride = 0;
  for_each_array(mesh, [&](const auto& array) { stride += array.empty() ? 0 : sizeof(array[0]); });
  std::vector<unsigned char> rows(count * stride);
  std::size_t at = 0;
  for_each_array(mesh, [&](const auto& array) {
    if (array.empty()) return;
    for (std::size_t v = 0; v < count; ++v) std::memcpy(&rows[v * stride + at], &array[v], sizeof(array[0]));
    at += sizeof(array[0]);
  });
  std::vector<std::uint32_t> order(count), first(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    return std::memcmp(&rows[a * stride], &rows[b * stride], stride);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int c = compare(a, b);
    return c != 0 ? c < 0 : a < b;
  });
  for (std::size_t i = 0; i < count; ++i)
    first[order[i]] = i > 0 && compare(order[i - 1], order[i]) == 0 ? first[order[i - 1]] : order[i];
  return first;
}

/// Triangles of which two corners are one vertex cover nothing.
std::vector<std::uint32_t> welded(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_equal(mesh);
  std::vector<std::uint32_t> result;
  result.reserve(mesh.indices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = first[mesh.indices[i]], b = first[mesh.indices[i + 1]],
                        c = first[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) result.insert(result.end(), {a, b, c});
  }
  return result;
}

std::int64_t used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t v : mesh.indices) used[v] = true;
  return std::count(used.begin(), used.end(), true);
}

LadderLevel figures(const Mesh& mesh, double error_m) {
  return {-1, mesh.triangle_count(), used_vertices(mesh), mesh_bytes(mesh), error_m};
}

double diagonal_of(const Mesh& mesh) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const std::uint32_t v : mesh.indices) {
    lo = glm::min(lo, dvec3(mesh.positions[v]));
    hi = glm::max(hi, dvec3(mesh.positions[v]));
  }
  return mesh.indices.empty() ? 0 : glm::length(hi - lo);
}

std::vector<std::uint32_t> simplified(const Mesh& mesh, std::size_t most_indices,
                                      const LadderOptions& options) {
  std::vector<std::uint32_t> fewer = mesh.indices;
  if (fewer.size() <= most_indices) return fewer;
  const unsigned flags = options.lock_borders ? unsigned{meshopt_SimplifyLockBorder} : 0u;
  fewer.resize(meshopt_simplify(fewer.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions[0].x,
                                mesh.positions.size(), sizeof(mesh.positions[0]), most_indices,
                                static_cast<float>(options.most_error), flags, nullptr));
  return fewer;
}

/// Puts the level below the others, or says why not.
std::string try_to_add(BuiltLadder& built, const Mesh& base, Mesh level, double most_error_m) {
  const std::string which = "level " + std::to_string(built.ladder.levels.size());
  if (level.indices.empty()) return which + " is empty, must have at least one triangle";
  const SurfaceDistance distance = surface_distance(base, level);
  if (distance.facing < kInsideOut)
    return which + " is turned inside out, must look the way of the mesh itself";
  if (!(distance.error_m() <= most_error_m)) return which + " is too far off";
  // A finer level may be off by more than a coarser one at the samples: what is coarser is trusted no more.
  const double error_m = std::max(distance.error_m(), built.ladder.levels.back().error_m);
  built.ladder.levels.push_back(figures(level, error_m));
  if (std::string defect = first_defect(built.ladder); !defect.empty()) {
    built.ladder.levels.pop_back();
    return defect;
  }
  level.name = base.name + ", " + which;
  built.coarser.push_back(std::move(level));
  return {};
}

}  // namespace

std::int64_t mesh_bytes(const Mesh& mesh) {
  std::size_t bytes = mesh.indices.size() * sizeof(std::uint32_t);
  for_each_array(mesh, [&](const auto& array) { bytes += array.size() * sizeof(array[0]); });
  return static_cast<std::int64_t>(bytes);
}

BuiltLadder build_ladder(const Mesh& mesh, const LadderOptions& options) {
  BuiltLadder built;
  if (mesh.indices.size() < 3) {
    built.ended_by = "the mesh has no triangles";
    return built;
  }
  built.ladder.levels.push_back(figures(mesh, 0));
  // Vertices that nothing uses would count as further sides of a seam.
  const Mesh joined = with_triangles(mesh, welded(mesh));
  const double most_error_m = options.most_error * diagonal_of(mesh);
  while (static_cast<int>(built.ladder.levels.size()) < options.most_levels) {
    const auto most_triangles = static_cast<std::size_t>(built.ladder.levels.back().triangles / 2);
    if (most_triangles < static_cast<std::size_t>(options.least_triangles)) {
      built.ended_by =
          "a further level would have fewer than " + std::to_string(options.least_triangles) + " triangles";
      return built;
    }
    const auto fewer = simplified(joined, 3 * most_triangles, options);
    built.ended_by = try_to_add(built, mesh, with_triangles(joined, fewer), most_error_m);
    if (!built.ended_by.empty()) return built;
  }
  built.ended_by = "there are " + std::to_string(options.most_levels) + " levels";
  return built;
}

BuiltLadder ladder_of(const Mesh& mesh, std::vector<Mesh> coarser) {
  BuiltLadder built;
  if (mesh.indices.size() < 3) {
    built.ended_by = "level 0 is empty, must have at least one triangle";
    return built;
  }
  built.ladder.levels.push_back(figures(mesh, 0));
  for (Mesh& level : coarser) {
    built.ended_by = try_to_add(built, mesh, std::move(level), HUGE_VAL);
    if (!built.ended_by.empty()) return built;
  }
  if (built.ladder.levels.size() < 2)
    built.ended_by = "a ladder has one level, must have at least two: the mesh and a coarser one";
  return built;
}

}  // namespace talisman::layers
