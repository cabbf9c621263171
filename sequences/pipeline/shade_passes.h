// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The passes behind shadows and reflections, and how a layer's term of the shading is drawn with them
/// [LS97 2.3, Fig. 5, 6].
///
///   shadow map     the casters' depths as seen from the light; kept while light and casters rest, whichever
///                  layer looks it up
///   reflection     what the layer mirrors, as a mirrored camera sees it, as large and dense as the sprite
///   that
///                  looks it up; drawn with each render of that sprite. What lies behind the mirror is cut
///                  off. A sprite of several mirrors (an aggregate, or `direct`) looks up one picture for
///                  each. One bounce: a mirror in a mirror shows its own colour and reflects nothing. What
///                  is mirrored is mirrored without fades.
///
/// What a scene does not call for makes no pass and allocates nothing.

#include <vector>

#include "chunker/multipass.h"
#include "chunker/shadow_map.h"
#include "layers/polyhedron.h"
#include "layers/state.h"

namespace talisman::sequences {

struct Settings;
struct Pipeline;

/// All that determines one light's shadow map.
struct ShadowMapKey {
  layers::LightState light;
  std::vector<layers::dmat4> world_from_casters;
  bool operator==(const ShadowMapKey&) const = default;
};

/// By index of Scene::lights; empty for lights that need none.
std::vector<ShadowMapKey> shadow_map_keys(const Pipeline& pipeline, const layers::SceneFrame& frame);

/// The lights whose maps drawing `layer` looks up, ascending.
std::vector<int> shadow_lights(const Pipeline& pipeline, const layers::Layer& layer);

struct ShadeCounters {
  int shadow_maps_drawn = 0, shadow_maps_reused = 0;
  int reflections_drawn = 0;
  std::int64_t shadow_polygons = 0;  ///< triangles of the casters, once per map drawn
  ShadeCounters& operator+=(const ShadeCounters& o);
  bool operator==(const ShadeCounters&) const = default;
};

/// Which maps are up to date, without their pixels: the same whether pictures are drawn or not.
class ShadePlan {
 public:
  /// Notes that `layer` is rendered as of the instant of `keys`; counts the passes that this takes.
  void add_render(const Pipeline& pipeline, const layers::Layer& layer, const std::vector<ShadowMapKey>& keys,
                  ShadeCounters& counters);

 private:
  std::vector<ShadowMapKey> drawn_;  ///< by light
};

/// The shadow maps that were drawn last, one per light.
class ShadowMapStore {
 public:
  /// The map of `light` at `key`, drawn if the one at hand shows another.
  const chunker::ShadowMap* find(const Pipeline& pipeline, const layers::SceneFrame& frame, int light,
                                 const ShadowMapKey& key);
  std::int64_t bytes() const;

 private:
  struct Entry {
    ShadowMapKey key;
    chunker::ShadowMap map;
    bool drawn = false;
  };
  std::vector<Entry> maps_;  ///< by light
};

/// The layer's term of the shading, at `frame`, through `placement`. The counters are those of the sprite and
/// of the reflection behind it.
chunker::RenderResult draw_layer(const Pipeline& pipeline, ShadowMapStore& maps,
                                 const chunker::PreparedScene& prepared, const layers::SceneFrame& frame,
                                 const layers::Layer& layer, const layers::SpritePlacement& placement);

/// What draw_layer encodes, as it is before that.
chunker::LinearImage draw_layer_linear(const Pipeline& pipeline, ShadowMapStore& maps,
                                       const chunker::PreparedScene& prepared,
                                       const layers::SceneFrame& frame, const layers::Layer& layer,
                                       const layers::SpritePlacement& placement);

/// All terms that `layer` holds, one pass each (chunker/multipass.h).
std::vector<chunker::TermImage> draw_terms(const Pipeline& pipeline, ShadowMapStore& maps,
                                           const chunker::PreparedScene& prepared,
                                           const layers::SceneFrame& frame, const layers::Layer& layer,
                                           const layers::SpritePlacement& placement,
                                           chunker::BasePasses base);

/// The given geometry layers in one pass, all terms of their shading at once, and their textures blended as
/// of `frame`. Fades are left to the compositor: sequences/pipeline/direct_picture.h.
chunker::RenderResult draw_in_one_pass(const Pipeline& pipeline, ShadowMapStore& maps,
                                       const chunker::PreparedScene& prepared,
                                       const layers::SceneFrame& frame, std::span<const int> geometry_layers,
                                       const layers::SpritePlacement& placement);

/// The multipliers of the layer's sprite at a time.
struct SpriteMultipliers {
  float alpha = 1;              ///< all four channels
  layers::vec3 color{1, 1, 1};  ///< colour alone
};
SpriteMultipliers multipliers_at(const layers::Layer& layer, double time_s);

}  // namespace talisman::sequences
