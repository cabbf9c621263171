// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From parts to triangles on the sprite: vertices are transformed once, triangles are rejected, cut, culled
/// and snapped.
///
/// A triangle is left out when it lies wholly outside the sprite, faces away (unless its material is
/// two-sided), has no area on the lattice, holds a vertex that is not finite, or has no sample in its
/// bounding box. The order of the list is the order of the parts and of their indices; it decides between
/// surfaces of equal depth (the earlier one is seen).

#include <span>
#include <vector>

#include "chunker/render.h"
#include "chunker/shade.h"
#include "chunker/triangle.h"

namespace talisman::chunker {

/// One part's shader and the attributes that its triangles refer to.
struct Batch {
  Shader shader;
  std::vector<Float4> attributes;
};

struct DrawList {
  layers::ivec2 size_px{0, 0};
  LightSet lights;                            ///< shaders refer to it: a list is not copied
  std::vector<ReflectionLookup> reflections;  ///< likewise, one per ShadeInputs::reflections
  ShadeTerm term = ShadeTerm::Full;
  bool adds = false;  ///< LightsHeld::One: the picture has no alpha
  std::vector<Batch> batches;
  std::vector<Triangle> triangles;
  std::int64_t polygons_in = 0;

  DrawList() = default;
  DrawList(const DrawList&) = delete;
  DrawList& operator=(const DrawList&) = delete;
};

/// Fills `list`. An unusable placement leaves it without triangles. Cost: O(vertices + triangles), in
/// parallel blocks whose results are joined in order.
void build_draw_list(const PreparedScene& prepared, const layers::SceneFrame& frame,
                     std::span<const int> parts, layers::ivec2 display_px,
                     const layers::SpritePlacement& placement, const RenderOptions& options,
                     const ShadeInputs& inputs, DrawList& list);

}  // namespace talisman::chunker
