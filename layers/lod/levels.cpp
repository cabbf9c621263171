// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/levels.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "layers/check.h"
#include "layers/seam.h"

namespace talisman::layers {
namespace {

/// By mesh: must its border stay?
std::vector<bool> meshes_with_neighbours(const Scene& scene, const LayerSet& set) {
  std::vector<bool> locked(scene.meshes.size(), false);
  for (const SharedEdge& edge : shared_edges(scene, set))  // in both directions
    locked[static_cast<std::size_t>(scene.parts[static_cast<std::size_t>(edge.part)].mesh)] = true;
  return locked;
}

std::size_t at_level(std::size_t count, int level) {
  return std::min(count - 1, static_cast<std::size_t>(level));
}

/// By how much lengths grow at most: exact where axes stay at right angles, else no less (Frobenius).
double largest_stretch(const dmat4& m) {
  const dvec3 x(m[0]), y(m[1]), z(m[2]);
  const double largest = std::max({glm::dot(x, x), glm::dot(y, y), glm::dot(z, z)});
  const double skew =
      std::max({std::fabs(glm::dot(x, y)), std::fabs(glm::dot(y, z)), std::fabs(glm::dot(z, x))});
  if (skew <= 1e-9 * largest) return std::sqrt(largest);
  return std::sqrt(glm::dot(x, x) + glm::dot(y, y) + glm::dot(z, z));
}

}  // namespace

Scene with_levels(Scene all, const LayerSet& set, LadderOptions options) {
  TALISMAN_CHECK(!all.levels);
  LevelSet made;
  const std::size_t meshes = all.meshes.size(), parts = all.parts.size();
  std::vector<bool> is_drawn(meshes, false);
  for (const Part& part : all.parts)
    if (!part.is_seam && part.mesh >= 0) is_drawn[static_cast<std::size_t>(part.mesh)] = true;
  const std::vector<bool> locked = meshes_with_neighbours(all, set);
  made.ladders.resize(meshes);
  made.boxes = mesh_boxes(all);
  for (std::size_t m = 0; m < meshes; ++m) {
    if (!is_drawn[m]) continue;
    options.lock_borders = locked[m];
    BuiltLadder built = build_ladder(all.meshes[m], options);
    for (std::size_t k = 0; k < built.ladder.levels.size(); ++k)
      built.ladder.levels[k].mesh = static_cast<int>(k == 0 ? m : all.meshes.size() + k - 1);
    for (Mesh& mesh : built.coarser) all.meshes.push_back(std::move(mesh));
    made.ladders[m] = std::move(built.ladder);
  }
  for (std::size_t p = 0; p < parts; ++p) {
    std::vector<int> levels{static_cast<int>(p)};
    const Part own = all.parts[p];
    if (!own.is_seam && own.mesh >= 0)
      for (const LadderLevel& level : made.ladders[static_cast<std::size_t>(own.mesh)].levels) {
        if (level.mesh == own.mesh) continue;
        Part part = own;
        part.mesh = level.mesh;
        part.is_level = true;
        levels.push_back(static_cast<int>(all.parts.size()));
        all.parts.push_back(std::move(part));
      }
    made.parts.push_back(std::move(levels));
  }
  all.levels = std::make_shared<const LevelSet>(std::move(made));
  return all;
}

Scene without_levels(Scene scene) {
  if (!scene.levels) return scene;
  scene.meshes.resize(scene.levels->ladders.size());
  scene.parts.resize(scene.levels->parts.size());
  scene.levels = nullptr;
  return scene;
}

bool may_have_levels(const Layer& layer) {
  return layer.kind == LayerKind::Geometry && layer.base < 0 && layer.factored == HeldTerms{} &&
         !layer.holds.reflection;
}

int level_count(const Scene& scene, const Layer& layer) {
  if (!scene.levels || !may_have_levels(layer)) return 1;
  std::size_t most = 1;
  for (const int part : layer.parts)
    most = std::max(most, scene.levels->parts[static_cast<std::size_t>(part)].size());
  return static_cast<int>(most);
}

double stretch_of(const Part& part, std::size_t i, const Layer& layer,
                  const std::vector<dmat4>& world_from_part) {
  double most = i < world_from_part.size() ? largest_stretch(world_from_part[i]) : 1;
  if (part.skin < 0) return most;
  for (std::size_t joint = layer.parts.size(); joint < world_from_part.size(); ++joint)
    most = std::max(most, largest_stretch(world_from_part[joint]));
  return most;
}

LayerLevel level_of(const Scene& scene, const Layer& layer, int level,
                    const std::vector<dmat4>& world_from_part) {
  LayerLevel result{layer.polygons, 0};
  if (!scene.levels) return result;
  for (std::size_t i = 0; i < layer.parts.size(); ++i) {
    const Part& part = scene.parts[static_cast<std::size_t>(layer.parts[i])];
    if (part.is_seam) continue;
    const auto& ladder = scene.levels->ladders[static_cast<std::size_t>(part.mesh)].levels;
    if (ladder.empty()) continue;
    const LadderLevel& drawn = ladder[at_level(ladder.size(), level)];
    result.polygons -= ladder[0].triangles - drawn.triangles;
    if (drawn.error_m > 0)
      result.error_m = std::max(result.error_m, drawn.error_m * stretch_of(part, i, layer, world_from_part));
  }
  return result;
}

Layer layer_at_level(const Scene& scene, Layer layer, int level) {
  if (!scene.levels) return layer;
  for (int& part : layer.parts) {
    const auto& ladder = scene.levels->parts[static_cast<std::size_t>(part)];
    part = ladder[at_level(ladder.size(), level)];
  }
  return layer;
}

}  // namespace talisman::layers
