// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/shade_passes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "chunker/mirror.h"
#include "layers/animation.h"
#include "layers/built_effects.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using chunker::ShadeInputs;
using chunker::ShadeTerm;
using layers::Affine2;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::Layer;
using layers::LayerKind;
using layers::SceneFrame;
using layers::SpritePlacement;

/// A term whose effect the build leaves out is none of a layer's.
constexpr bool kShadows = layers::is_built(layers::Effect::ShadowMap);
constexpr bool kMirrors = layers::is_built(layers::Effect::ReflectionMap);
constexpr bool kTextureLayers = layers::is_built(layers::Effect::TextureLayers);

ShadeTerm term_of(const Layer& layer) {
  switch (layer.kind) {
    case LayerKind::Geometry:
      if (kTextureLayers && layer.factored.second_texture) return ShadeTerm::Texture1;
      return layers::is_built(layers::Effect::SpecularLayer) && layer.factored.specular ? ShadeTerm::Base
                                                                                        : ShadeTerm::Full;
    case LayerKind::Shadow:
      return ShadeTerm::Shadow;
    case LayerKind::Specular:
      return ShadeTerm::Specular;
    case LayerKind::Reflection:
      return ShadeTerm::Reflection;
    case LayerKind::Texture:
      return ShadeTerm::Texture2;
  }
  return ShadeTerm::Full;
}

bool any_shadows(const Pipeline& pipeline) { return kShadows && !pipeline.layers.casting_parts.empty(); }

std::int64_t casting_polygons(const Pipeline& pipeline) {
  std::int64_t polygons = 0;
  for (const int part : pipeline.layers.casting_parts)
    polygons += pipeline.scene.meshes[pipeline.scene.parts[part].mesh].triangle_count();
  return polygons;
}

/// The lights that have maps: all, or `only` that one if it has.
std::vector<int> lights_with_maps(const Pipeline& pipeline, int only) {
  std::vector<int> lights;
  for (int i = 0; i < static_cast<int>(pipeline.scene.lights.size()); ++i)
    if (pipeline.scene.lights[i].casts_shadow && (only < 0 || only == i)) lights.push_back(i);
  return lights;
}

/// Pointers to the maps of `lights`, by index of Scene::lights.
std::vector<const chunker::ShadowMap*> maps_for(const Pipeline& pipeline, ShadowMapStore& maps,
                                                const SceneFrame& frame, const std::vector<int>& lights) {
  std::vector<const chunker::ShadowMap*> by_light;
  if (lights.empty()) return by_light;
  const std::vector<ShadowMapKey> keys = shadow_map_keys(pipeline, frame);
  by_light.resize(keys.size(), nullptr);
  for (const int light : lights) by_light[light] = maps.find(pipeline, frame, light, keys[light]);
  return by_light;
}

// --- Reflections ---

struct WorldPlane {
  dvec3 point, normal;
  double height(const dvec3& p) const { return glm::dot(normal, p - point); }
};

WorldPlane mirror_of(const SceneFrame& frame, const Layer& layer) {
  const layers::dmat4& world = frame.world_from_node[layer.plane->node];
  const dvec3 normal = glm::transpose(glm::inverse(layers::dmat3(world))) * layer.plane->normal;
  return {dvec3(world * dvec4(layer.plane->point, 1)), normal / glm::length(normal)};
}

/// The parts of the mirrored layers that reach before the mirror, on the eye's side: the others need not even
/// be cut off.
std::vector<int> parts_before(const Pipeline& pipeline, const SceneFrame& frame, const Layer& layer,
                              const WorldPlane& mirror) {
  const double eye = mirror.height(dvec3(frame.camera.world_from_camera[3]));
  std::vector<int> parts;
  for (const int id : layer.reflected) {
    const Layer& seen = pipeline.layers.layers[id];
    const auto points = layers::world_points(frame, seen, pipeline.bounds[id]);
    if (std::any_of(points.begin(), points.end(), [&](const dvec3& p) { return mirror.height(p) * eye > 0; }))
      parts.insert(parts.end(), seen.parts.begin(), seen.parts.end());
  }
  return parts;
}

/// An upright rectangle of the display around a sprite, as dense as the sprite is.
SpritePlacement around(const SpritePlacement& sprite, int max_sprite_px) {
  const Affine2& m = sprite.screen_from_sprite;
  layers::RectD bounds;
  for (const dvec2& corner : {dvec2{0, 0}, dvec2{1, 0}, dvec2{0, 1}, dvec2{1, 1}})
    bounds.include(m(corner * dvec2(sprite.size_px)));
  const double texel_px = std::sqrt(std::fabs(m.determinant()));
  const double step = std::max({texel_px, bounds.width() / max_sprite_px, bounds.height() / max_sprite_px});
  // One texel more on each side, and texels on pixels where their densities are equal.
  const dvec2 lo = step * (glm::floor(bounds.lo / step) - 1.0);
  const dvec2 count = glm::ceil((bounds.hi - lo) / step) + 1.0;
  SpritePlacement placement;
  placement.screen_from_sprite = {step, 0, lo.x, 0, step, lo.y};
  placement.size_px = layers::ivec2(count);
  return placement;
}

/// A picture of what `layer` mirrors, with the map that finds it.
struct Mirrored {
  chunker::RenderResult picture;
  Affine2 picture_from_screen;
};

Mirrored draw_mirrored(const Pipeline& pipeline, ShadowMapStore& maps, const chunker::PreparedScene& prepared,
                       const SceneFrame& frame, const Layer& layer, const SpritePlacement& placement) {
  Mirrored mirrored;
  const WorldPlane mirror = mirror_of(frame, layer);
  if (placement.empty() || !std::isfinite(mirror.height({0, 0, 0}))) return mirrored;
  const SpritePlacement wide = around(placement, pipeline.settings.placement.max_sprite_px);
  const std::optional<Affine2> picture_from_screen = inverse(wide.screen_from_sprite);
  if (!picture_from_screen) return mirrored;
  ShadeInputs inputs;
  const auto by_light = maps_for(pipeline, maps, frame,
                                 any_shadows(pipeline) ? lights_with_maps(pipeline, -1) : std::vector<int>{});
  inputs.shadow_maps = by_light;
  inputs.kept = chunker::before_mirror(frame, mirror.point, mirror.normal);
  mirrored.picture =
      chunker::render(prepared, chunker::mirrored_frame(frame, mirror.point, mirror.normal),
                      parts_before(pipeline, frame, layer, mirror), pipeline.settings.view.display_px, wide,
                      pipeline.settings.render, inputs);
  mirrored.picture_from_screen = *picture_from_screen;
  return mirrored;
}

// --- What a sprite holds ---

/// Parts, and what their terms look up.
struct Contents {
  std::vector<int> parts;
  ShadeTerm term = ShadeTerm::Full;
  int light = -1;
  bool shadows = false;
  std::vector<const Layer*> mirrors;
  std::vector<chunker::TextureBlend> blends;
};

/// `visit(shade layer)` for those of the geometry layer `base`, which follow it.
template <typename Visit>
void for_each_shade(const Pipeline& pipeline, int base, const Visit& visit) {
  const std::vector<Layer>& all = pipeline.layers.layers;
  for (std::size_t k = base + 1; k < all.size() && all[k].base == base; ++k) visit(all[k]);
}

/// `visit(layer)` for all layers whose terms the sprite of `layer` holds: itself, or an aggregate's members
/// and their shade layers.
template <typename Visit>
void for_each_held(const Pipeline& pipeline, const Layer& layer, const Visit& visit) {
  if (!layer.is_aggregate()) visit(layer);
  for (const int member : layer.members) {
    visit(pipeline.layers.layers[member]);
    for_each_shade(pipeline, member, visit);
  }
}

std::vector<const Layer*> mirrors_in(const Pipeline& pipeline, const Layer& layer) {
  std::vector<const Layer*> mirrors;
  if constexpr (!kMirrors) return mirrors;
  for_each_held(pipeline, layer, [&](const Layer& held) {
    if (held.holds.reflection) mirrors.push_back(&held);
  });
  return mirrors;
}

/// The factors with which the compositor blends the textures of `base` at a time, if it does.
void add_blend(const Pipeline& pipeline, const Layer& base, double time_s, Contents& contents) {
  if constexpr (!kTextureLayers) return;
  for_each_shade(pipeline, base.id, [&](const Layer& shade) {
    if (shade.kind != LayerKind::Texture) return;
    const float first = multipliers_at(base, time_s).color.x, second = multipliers_at(shade, time_s).color.x;
    contents.blends.push_back({{first, second}, base.parts});
  });
}

/// All terms of some geometry layers together.
Contents all_terms_of(const Pipeline& pipeline, std::span<const int> geometry_layers, double time_s) {
  Contents contents;
  const auto hold = [&](const Layer& layer) {
    contents.shadows = contents.shadows || (kShadows && layer.holds.shadows);
    if (kMirrors && layer.holds.reflection) contents.mirrors.push_back(&layer);
  };
  for (const int id : geometry_layers) {
    const Layer& layer = pipeline.layers.layers[id];
    contents.parts.insert(contents.parts.end(), layer.parts.begin(), layer.parts.end());
    hold(layer);
    for_each_shade(pipeline, id, hold);
    add_blend(pipeline, layer, time_s, contents);
  }
  return contents;
}

Contents contents_of(const Pipeline& pipeline, const Layer& layer, double time_s) {
  if (layer.is_aggregate()) {
    Contents contents = all_terms_of(pipeline, layer.members, time_s);
    contents.parts = layer.parts;  // in their own order
    return contents;
  }
  return {
      layer.parts, term_of(layer), layer.light, kShadows && layer.holds.shadows, mirrors_in(pipeline, layer),
      {}};
}

/// What drawing `contents` looks up, kept as long as it is drawn.
class LookedUp {
 public:
  LookedUp(const Pipeline& pipeline, ShadowMapStore& maps, const chunker::PreparedScene& prepared,
           const SceneFrame& frame, const Contents& contents, const SpritePlacement& placement) {
    inputs_.term = contents.term;
    inputs_.light = contents.light;
    inputs_.texture_blends = contents.blends;
    if (contents.shadows)
      by_light_ = maps_for(pipeline, maps, frame, lights_with_maps(pipeline, contents.light));
    inputs_.shadow_maps = by_light_;
    for (const Layer* mirror : contents.mirrors)
      mirrored_.push_back(draw_mirrored(pipeline, maps, prepared, frame, *mirror, placement));
    for (std::size_t i = 0; i < mirrored_.size(); ++i)
      reflections_.push_back(
          {&mirrored_[i].picture.sprite, mirrored_[i].picture_from_screen, contents.mirrors[i]->parts});
    inputs_.reflections = reflections_;
  }
  LookedUp(const LookedUp&) = delete;
  LookedUp& operator=(const LookedUp&) = delete;

  const ShadeInputs& inputs() const { return inputs_; }
  void add_passes(chunker::RenderCounters& counters) const {
    for (const Mirrored& m : mirrored_) counters += m.picture.counters;
  }

 private:
  std::vector<const chunker::ShadowMap*> by_light_;
  std::vector<Mirrored> mirrored_;
  std::vector<chunker::Reflection> reflections_;
  ShadeInputs inputs_;
};

chunker::RenderResult draw(const Pipeline& pipeline, ShadowMapStore& maps,
                           const chunker::PreparedScene& prepared, const SceneFrame& frame,
                           const Contents& contents, const SpritePlacement& placement) {
  const LookedUp looked_up(pipeline, maps, prepared, frame, contents, placement);
  chunker::RenderResult result =
      chunker::render(prepared, frame, contents.parts, pipeline.settings.view.display_px, placement,
                      pipeline.settings.render, looked_up.inputs());
  looked_up.add_passes(result.counters);
  return result;
}

}  // namespace

std::vector<ShadowMapKey> shadow_map_keys(const Pipeline& pipeline, const SceneFrame& frame) {
  std::vector<ShadowMapKey> keys;
  if (!any_shadows(pipeline)) return keys;
  keys.resize(pipeline.scene.lights.size());
  const std::vector<layers::dmat4> casters = layers::part_matrices(frame, pipeline.layers.casting_parts);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (pipeline.scene.lights[i].casts_shadow) keys[i] = {frame.lights[i], casters};
  return keys;
}

std::vector<int> shadow_lights(const Pipeline& pipeline, const Layer& layer) {
  const bool looks_up =
      kShadows && (layer.holds.shadows || (kMirrors && layer.holds.reflection && any_shadows(pipeline)));
  return looks_up ? lights_with_maps(pipeline, layer.light) : std::vector<int>{};
}

ShadeCounters& ShadeCounters::operator+=(const ShadeCounters& o) {
  shadow_maps_drawn += o.shadow_maps_drawn;
  shadow_maps_reused += o.shadow_maps_reused;
  reflections_drawn += o.reflections_drawn;
  shadow_polygons += o.shadow_polygons;
  return *this;
}

void ShadePlan::add_render(const Pipeline& pipeline, const Layer& layer,
                           const std::vector<ShadowMapKey>& keys, ShadeCounters& counters) {
  counters.reflections_drawn += static_cast<int>(mirrors_in(pipeline, layer).size());
  for (const int light : shadow_lights(pipeline, layer)) {
    drawn_.resize(keys.size());
    if (!drawn_[light].world_from_casters.empty() && drawn_[light] == keys[light]) {
      ++counters.shadow_maps_reused;
      continue;
    }
    ++counters.shadow_maps_drawn;
    counters.shadow_polygons += casting_polygons(pipeline);
    drawn_[light] = keys[light];
  }
}

const chunker::ShadowMap* ShadowMapStore::find(const Pipeline& pipeline, const SceneFrame& frame, int light,
                                               const ShadowMapKey& key) {
  maps_.resize(pipeline.scene.lights.size());
  Entry& entry = maps_[light];
  if (!entry.drawn || !(entry.key == key)) {
    entry.map = chunker::make_shadow_map(frame, light, pipeline.layers.casting_parts);
    entry.key = key;
    entry.drawn = true;
  }
  return &entry.map;
}

std::int64_t ShadowMapStore::bytes() const {
  std::int64_t sum = 0;
  for (const Entry& entry : maps_) sum += entry.map.bytes();
  return sum;
}

chunker::RenderResult draw_layer(const Pipeline& pipeline, ShadowMapStore& maps,
                                 const chunker::PreparedScene& prepared, const SceneFrame& frame,
                                 const Layer& layer, const SpritePlacement& placement) {
  return draw(pipeline, maps, prepared, frame, contents_of(pipeline, layer, frame.time_s), placement);
}

chunker::LinearImage draw_layer_linear(const Pipeline& pipeline, ShadowMapStore& maps,
                                       const chunker::PreparedScene& prepared, const SceneFrame& frame,
                                       const Layer& layer, const SpritePlacement& placement) {
  const Contents contents = contents_of(pipeline, layer, frame.time_s);
  const LookedUp looked_up(pipeline, maps, prepared, frame, contents, placement);
  return chunker::render_linear(prepared, frame, contents.parts, pipeline.settings.view.display_px, placement,
                                pipeline.settings.render, looked_up.inputs());
}

std::vector<chunker::TermImage> draw_terms(const Pipeline& pipeline, ShadowMapStore& maps,
                                           const chunker::PreparedScene& prepared, const SceneFrame& frame,
                                           const Layer& layer, const SpritePlacement& placement,
                                           chunker::BasePasses base) {
  const Contents contents = contents_of(pipeline, layer, frame.time_s);
  const LookedUp looked_up(pipeline, maps, prepared, frame, contents, placement);
  return chunker::render_terms(prepared, frame, contents.parts, pipeline.settings.view.display_px, placement,
                               pipeline.settings.render, looked_up.inputs(), base);
}

chunker::RenderResult draw_in_one_pass(const Pipeline& pipeline, ShadowMapStore& maps,
                                       const chunker::PreparedScene& prepared, const SceneFrame& frame,
                                       std::span<const int> geometry_layers,
                                       const SpritePlacement& placement) {
  return draw(pipeline, maps, prepared, frame, all_terms_of(pipeline, geometry_layers, frame.time_s),
              placement);
}

SpriteMultipliers multipliers_at(const Layer& layer, double time_s) {
  SpriteMultipliers m;
  if (!layer.fade.values.empty()) m.alpha = static_cast<float>(layers::value_at(layer.fade, time_s));
  if (kTextureLayers && !layer.gain.values.empty())
    m.color = layers::vec3(static_cast<float>(layers::value_at(layer.gain, time_s)));
  m.alpha = std::clamp(m.alpha, 0.0f, 1.0f);
  m.color = glm::clamp(m.color, 0.0f, 1.0f);
  return m;
}

}  // namespace talisman::sequences
