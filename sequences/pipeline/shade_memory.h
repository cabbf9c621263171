// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is remembered of the passes behind shadows and reflections: as of when each shadow map was drawn, and its
/// pixels; and which layers look them up.
///
/// A shadow map is kept while its light and its casters rest, whichever layer looks it up; and longer where the
/// regulator says so (regulator/shadow_maps.h). What a scene does not call for makes no pass and allocates nothing.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "chunker/shadow_map.h"
#include "layers/layer.h"
#include "layers/state.h"

namespace talisman::sequences {

/// `visit(shade layer)` for those of the geometry layer `base`, which follow it.
template <typename Visit>
void for_each_shade(const layers::LayerSet& set, int base, const Visit& visit) {
  const std::vector<layers::Layer>& all = set.layers;
  for (std::size_t k = base + 1; k < all.size() && all[k].base == base; ++k) visit(all[k]);
}

/// `visit(layer)` for all layers whose terms the sprite of `layer` holds: itself, or an aggregate's members
/// and their shade layers.
template <typename Visit>
void for_each_held(const layers::LayerSet& set, const layers::Layer& layer, const Visit& visit) {
  if (!layer.is_aggregate()) visit(layer);
  for (const int member : layer.members) {
    visit(set.layers[member]);
    for_each_shade(set, member, visit);
  }
}

/// The layers whose reflections drawing `layer` looks up, in the order of for_each_held.
std::vector<const layers::Layer*> mirrors_in(const layers::LayerSet& set, const layers::Layer& layer);

/// Are there shadow maps at all?
bool any_shadows(const layers::LayerSet& set);

/// The lights that have maps: all, or `only` that one if it has.
std::vector<int> lights_with_maps(const layers::Scene& scene, int only);

/// All that determines one light's shadow map.
struct ShadowMapKey {
  layers::LightState light;
  std::vector<layers::dmat4> world_from_casters;
  bool operator==(const ShadowMapKey&) const = default;
};

/// By index of Scene::lights; empty for lights that need none.
std::vector<ShadowMapKey> shadow_map_keys(const layers::Scene& scene, const layers::LayerSet& set,
                                          const layers::SceneFrame& frame);

/// The lights whose maps drawing `layer` looks up, ascending.
std::vector<int> shadow_lights(const layers::Scene& scene, const layers::LayerSet& set,
                               const layers::Layer& layer);

/// What drawing the map of one light costs.
struct ShadowMapCost {
  std::int64_t polygons = 0;  ///< triangles of the casters
  std::int64_t pixels = 0;    ///< texels of its faces
  std::int64_t chunks = 0;    ///< 32×32 chunks of them
};

/// Triangles of all that casts.
std::int64_t casting_polygons(const layers::Scene& scene, const layers::LayerSet& set);

struct ShadeCounters {
  int shadow_maps_drawn = 0, shadow_maps_reused = 0;
  int reflections_drawn = 0;
  std::int64_t shadow_polygons = 0;  ///< triangles of the casters, once per map drawn
  std::int64_t shadow_pixels = 0;    ///< texels of the maps drawn
  ShadeCounters& operator+=(const ShadeCounters& o);
  bool operator==(const ShadeCounters&) const = default;
};

/// Which maps are up to date under the policy `reference`, which draws each whenever it is looked up and out of
/// date.
class ShadePlan {
 public:
  /// Notes that `layer` is rendered as of the instant of `keys`; counts the passes that this takes. `costs` by
  /// light.
  void add_render(const layers::Scene& scene, const layers::LayerSet& set, const layers::Layer& layer,
                  const std::vector<ShadowMapKey>& keys, const std::vector<ShadowMapCost>& costs,
                  ShadeCounters& counters);

 private:
  std::vector<ShadowMapKey> drawn_;  ///< by light
};

/// As of when a shadow map was drawn, and how.
struct ShadowMapInstant {
  int light = -1;
  int depicts_frame = -1;  ///< -1: never drawn
  int known = -1;          ///< the frame in which that instant was expected; itself where it was known
  double resolution = 1;   ///< relative to what the light's author asks for
  bool operator==(const ShadowMapInstant&) const = default;
};

/// What is remembered of one light's map: all that a later frame compares it with.
struct ShadowMapMemory {
  ShadowMapKey key;
  ShadowMapInstant instant;
  int frame_rendered = -1;
  int frames_short_of_area = 0;
  std::vector<std::vector<layers::dvec3>>
      world_points;  ///< of what casts, by layer id, where holding it is judged
};

/// A light whose map is as of another instant than the sprite, or coarser than its author asks for.
struct HeldMap {
  int light = -1;
  const layers::SceneFrame* frame = nullptr;  ///< the scene at the map's instant
  double resolution = 1;
};

/// Texels on each side of a map that is drawn at a share of the resolution that its author asks for; ≥ 1.
int map_resolution_px(const layers::Light& light, double resolution);

/// The shadow maps that were drawn last, one per light.
class ShadowMapStore {
 public:
  /// The map of `light` at `key`, drawn if the one at hand shows another, or at another resolution (0 … 1).
  const chunker::ShadowMap* find(const layers::Scene& scene, const layers::LayerSet& set,
                                 const layers::SceneFrame& frame, int light, const ShadowMapKey& key,
                                 double resolution = 1);
  std::int64_t bytes() const;

 private:
  struct Entry {
    ShadowMapKey key;
    chunker::ShadowMap map;
    double resolution = 1;
    bool drawn = false;
  };
  std::vector<Entry> maps_;  ///< by light
};

}  // namespace talisman::sequences
