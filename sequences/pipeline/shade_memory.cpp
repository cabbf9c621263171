// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/shade_memory.h"

#include <algorithm>
#include <cmath>

#include "layers/animation.h"
#include "layers/built_effects.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerSet;
using layers::Scene;
using layers::SceneFrame;

/// A term whose effect the build leaves out is none of a layer's.
constexpr bool kShadows = layers::is_built(layers::Effect::ShadowMap);
constexpr bool kMirrors = layers::is_built(layers::Effect::ReflectionMap);

}  // namespace

std::int64_t casting_polygons(const Scene& scene, const LayerSet& set) {
  std::int64_t polygons = 0;
  for (const int part : set.casting_parts) polygons += scene.meshes[scene.parts[part].mesh].triangle_count();
  return polygons;
}

int map_resolution_px(const layers::Light& light, double resolution) {
  return std::max(1, static_cast<int>(std::lround(light.shadow.resolution_px * resolution)));
}

std::vector<const Layer*> mirrors_in(const LayerSet& set, const Layer& layer) {
  std::vector<const Layer*> mirrors;
  if constexpr (!kMirrors) return mirrors;
  for_each_held(set, layer, [&](const Layer& held) {
    if (held.holds.reflection) mirrors.push_back(&held);
  });
  return mirrors;
}

bool any_shadows(const LayerSet& set) { return kShadows && !set.casting_parts.empty(); }

std::vector<int> lights_with_maps(const Scene& scene, int only) {
  std::vector<int> lights;
  for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i)
    if (scene.lights[i].casts_shadow && (only < 0 || only == i)) lights.push_back(i);
  return lights;
}

std::vector<ShadowMapKey> shadow_map_keys(const Scene& scene, const LayerSet& set, const SceneFrame& frame) {
  std::vector<ShadowMapKey> keys;
  if (!any_shadows(set)) return keys;
  keys.resize(scene.lights.size());
  const std::vector<layers::dmat4> casters = layers::part_matrices(frame, set.casting_parts);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (scene.lights[i].casts_shadow) keys[i] = {frame.lights[i], casters};
  return keys;
}

std::vector<int> shadow_lights(const Scene& scene, const LayerSet& set, const Layer& layer) {
  const bool looks_up =
      kShadows && (layer.holds.shadows || (kMirrors && layer.holds.reflection && any_shadows(set)));
  return looks_up ? lights_with_maps(scene, layer.light) : std::vector<int>{};
}

ShadeCounters& ShadeCounters::operator+=(const ShadeCounters& o) {
  shadow_maps_drawn += o.shadow_maps_drawn;
  shadow_maps_reused += o.shadow_maps_reused;
  reflections_drawn += o.reflections_drawn;
  shadow_polygons += o.shadow_polygons;
  shadow_pixels += o.shadow_pixels;
  return *this;
}

void ShadePlan::add_render(const Scene& scene, const LayerSet& set, const Layer& layer,
                           const std::vector<ShadowMapKey>& keys, const std::vector<ShadowMapCost>& costs,
                           ShadeCounters& counters) {
  counters.reflections_drawn += static_cast<int>(mirrors_in(set, layer).size());
  for (const int light : shadow_lights(scene, set, layer)) {
    drawn_.resize(keys.size());
    if (!drawn_[light].world_from_casters.empty() && drawn_[light] == keys[light]) {
      ++counters.shadow_maps_reused;
      continue;
    }
    ++counters.shadow_maps_drawn;
    counters.shadow_polygons += costs[light].polygons;
    counters.shadow_pixels += costs[light].pixels;
    drawn_[light] = keys[light];
  }
}

const chunker::ShadowMap* ShadowMapStore::find(const Scene& scene, const LayerSet& set,
                                               const SceneFrame& frame, int light, const ShadowMapKey& key,
                                               double resolution) {
  maps_.resize(scene.lights.size());
  Entry& entry = maps_[light];
  if (!entry.drawn || !(entry.key == key) || entry.resolution != resolution) {
    layers::ShadowMapOptions options = scene.lights[light].shadow;
    options.resolution_px = map_resolution_px(scene.lights[light], resolution);
    entry.map = chunker::make_shadow_map(frame, light, set.casting_parts, options);
    entry.key = key;
    entry.resolution = resolution;
    entry.drawn = true;
  }
  return &entry.map;
}

std::int64_t ShadowMapStore::bytes() const {
  std::int64_t sum = 0;
  for (const Entry& entry : maps_) sum += entry.map.bytes();
  return sum;
}

}  // namespace talisman::sequences
