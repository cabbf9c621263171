// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The levels of detail of a scene: ladders of its meshes, and parts that stand for others.
///
/// A coarser level is a mesh and, for each part with the mesh it is a level of, a part with the same node, material and
/// skin: whoever draws a layer coarser draws these in place of its own. Both lie behind the scene's own meshes and parts
/// and are taken by no layer. Decisions are made of the layer's own parts; a level has a choice of its base's vertices, so
/// it lies within the same bounds.
///
/// Seams have no levels, and edges that a layer shares with another one (layers/seam.h) stay as they are, so that no
/// crack opens between a layer at one level and its neighbour at another.

#include <cstdint>
#include <vector>

#include "layers/layer.h"
#include "layers/lod/simplify.h"
#include "layers/part_box.h"

namespace talisman::layers {

struct LevelSet {
  std::vector<Ladder> ladders;          ///< by own mesh of the scene; no level: nothing is drawn with it
  std::vector<std::vector<int>> parts;  ///< by own part: itself, then those that stand for it, finest first
  std::vector<MeshBox> boxes;           ///< by own mesh
};

/// The scene, which has none yet, with `levels`. Whoever changes its meshes or parts takes them away first, and makes them
/// anew. Cost: build_ladder for each mesh, and shared_edges once.
Scene with_levels(Scene scene, const LayerSet& set, LadderOptions options = {});
/// The scene as it was before; also where it has none.
Scene without_levels(Scene scene);

/// Can the layer be drawn coarser? Not a shade layer, nor one that has shades or holds a mirrored picture: their pictures
/// have to lie on each other.
bool may_have_levels(const Layer& layer);

/// The most levels of any of its parts; 1: there is nothing coarser. At level k each part is drawn at its own level k, or
/// at its coarsest.
int level_count(const Scene& scene, const Layer& layer);

/// A layer at one level.
struct LayerLevel {
  std::int64_t polygons = 0;  ///< triangles, as Layer::polygons
  double error_m = 0;         ///< the largest of its parts, in the world: scaled as `world_from_part` say
};
/// `world_from_part`: of each part's node, joints of skinned ones behind (LayerState).
LayerLevel level_of(const Scene& scene, const Layer& layer, int level,
                    const std::vector<dmat4>& world_from_part);

/// By how much lengths of part `i` of the layer grow at most.
double stretch_of(const Part& part, std::size_t i, const Layer& layer,
                  const std::vector<dmat4>& world_from_part);

/// The layer with the parts of a level.
Layer layer_at_level(const Scene& scene, Layer layer, int level);

}  // namespace talisman::layers
