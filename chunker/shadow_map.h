// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does a light reach a point, or is something in between? [LS97 2.3, Fig. 5; Segal92]
///
///   v(P) = 1/n² Σ over n × n texels around P's place in the map:  1 if z(P) ≤ z_map(texel), else 0
///
/// z is the distance along the map's view axis. A map holds, per texel, the z of the nearest caster, pushed
/// back by the bias (so that looking up costs one comparison and needs no normal):
///
///   bias = t · bias_texels + slope_bias · (r + ½) · min(|∂z/∂x| + |∂z/∂y|, 16 t)    t: side of a texel there
///
/// n = 2r + 1: percentage-closer filter. v is 0 … 1 and what is outside the map, or before its near plane, is
/// lit.
///
/// Which maps. Directional: one, orthographic, fitted to the casters on a grid that is fixed in the world
/// (chunker/shadow_view.h). Spot: one, perspective, as wide as its
/// outer cone; wider than 70° from its axis: as a point. Point: one towards the casters if they fit into 70°
/// around their centre's direction, and six around the light if they do not, or if the light is among them.
///
/// Casters are drawn from both sides. A caster whose material has opacity below one half casts no shadow;
/// any other casts a full one. Textures do not cut holes.
///
/// The map is rasterised by the chunk renderer's own transform, clipping, bins and coverage (one of the 16
/// samples of a texel, so that meshes stay watertight), chunks being independent jobs: the same bits for any
/// number of threads.

#include <cstdint>
#include <span>
#include <vector>

#include "chunker/rows34.h"
#include "layers/scene.h"

namespace talisman::chunker {

/// tan 70°: the most that one perspective map takes in, from its axis.
inline constexpr double kWidestShadowTan = 2.75;

/// The picture of one direction of view from a light.
struct ShadowFace {
  Rows34 map_from_world;      ///< orthographic: (x, y, z); else (x w, y w, w), z = w; x, y in texels
  std::vector<float> depths;  ///< row by row; +∞: nothing casts there
};

/// A plain value: keep it while light and casters rest.
class ShadowMap {
 public:
  ShadowMap() = default;  ///< lit everywhere

  /// v at a point of the world, 0 (in shadow) … 1 (lit). A point that is not finite is lit.
  float visibility(const layers::dvec3& world) const;

  bool empty() const { return faces_.empty(); }  ///< lit everywhere
  int resolution_px() const { return resolution_px_; }
  std::span<const ShadowFace> faces() const { return faces_; }  ///< 0, 1 or 6
  std::int64_t bytes() const;
  std::int64_t polygons_drawn() const { return polygons_drawn_; }  ///< over all faces, after clipping

 private:
  friend class ShadowMapBuilder;
  const ShadowFace* face_of(const layers::dvec3& world) const;

  std::vector<ShadowFace> faces_;
  layers::dvec3 light_{0, 0, 0};  ///< six faces: their common eye
  int resolution_px_ = 0, pcf_radius_ = 0;
  bool orthographic_ = false;
  std::int64_t polygons_drawn_ = 0;
};

/// The map of light `light` (index of Scene::lights) over the parts that cast. Empty, that is lit everywhere:
/// an ambient light, a light or casters that are not finite, no casters, resolution 0. Cost: O(vertices) +
/// O(triangle–chunk pairs) + O(texels), per face.
ShadowMap make_shadow_map(const layers::SceneFrame& frame, int light, std::span<const int> casters,
                          const layers::ShadowMapOptions& options);
/// With the light's own options.
ShadowMap make_shadow_map(const layers::SceneFrame& frame, int light, std::span<const int> casters);

}  // namespace talisman::chunker
