// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/shade_passes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "chunker/late_chunks.h"
#include "chunker/mirror.h"
#include "layers/animation.h"
#include "layers/built_effects.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/shade_ratio.h"

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
using layers::LayerSet;
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
    case LayerKind::Light:
      if (kTextureLayers && layer.factored.second_texture)
        return layer.holds.second_texture ? ShadeTerm::Texture2 : ShadeTerm::Texture1;
      return layers::is_built(layers::Effect::SpecularLayer) && layer.factored.specular ? ShadeTerm::Base
                                                                                        : ShadeTerm::Full;
  }
  return ShadeTerm::Full;
}

chunker::LightsHeld lights_of(const Layer& layer) {
  if (layer.kind == LayerKind::Light) return chunker::LightsHeld::One;
  const bool elsewhere = layer.shadows_as == layers::ShadowsAs::Light &&
                         (layer.kind == LayerKind::Geometry || layer.kind == LayerKind::Texture);
  return kShadows && elsewhere ? chunker::LightsHeld::Unmapped : chunker::LightsHeld::All;
}

/// Pointers to the maps of `lights`, by index of Scene::lights.
std::vector<const chunker::ShadowMap*> maps_for(const Drawing& drawing, const std::vector<int>& lights) {
  std::vector<const chunker::ShadowMap*> by_light;
  if (lights.empty()) return by_light;
  const auto& [pipeline, layers, maps, prepared, frame, held, seen] = drawing;
  const std::vector<ShadowMapKey> keys = shadow_map_keys(pipeline.scene, layers.set(), frame);
  by_light.resize(keys.size(), nullptr);
  for (const int light : lights) {
    const auto old = std::find_if(held.begin(), held.end(), [&](auto& h) { return h.light == light; });
    by_light[light] =
        old == held.end()
            ? maps.find(pipeline.scene, layers.set(), frame, light, keys[light])
            : maps.find(pipeline.scene, layers.set(), *old->frame, light,
                        shadow_map_keys(pipeline.scene, layers.set(), *old->frame)[light], old->resolution);
  }
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
std::vector<int> parts_before(const Drawing& drawing, const Layer& layer, const WorldPlane& mirror) {
  const double eye = mirror.height(dvec3(drawing.frame.camera.world_from_camera[3]));
  std::vector<int> parts;
  for (const int id : layer.reflected) {
    const Layer& seen = drawing.layers[id];
    const auto points = layers::world_points(drawing.frame, seen, drawing.layers.bound(id));
    if (std::any_of(points.begin(), points.end(), [&](const dvec3& p) { return mirror.height(p) * eye > 0; }))
      parts.insert(parts.end(), seen.parts.begin(), seen.parts.end());
  }
  return parts;
}

/// A picture of what `layer` mirrors, with the map that finds it.
struct Mirrored {
  chunker::RenderResult picture;
  Affine2 picture_from_screen;
};

Mirrored draw_mirrored(const Drawing& drawing, const Layer& layer, const SpritePlacement& placement) {
  const auto& [pipeline, layers, maps, prepared, frame, held, seen] = drawing;
  Mirrored mirrored;
  const WorldPlane mirror = mirror_of(frame, layer);
  if (placement.empty() || !std::isfinite(mirror.height({0, 0, 0}))) return mirrored;
  const SpritePlacement wide = mirrored_placement(placement, pipeline.settings.placement.max_sprite_px);
  const std::optional<Affine2> picture_from_screen = inverse(wide.screen_from_sprite);
  if (!picture_from_screen) return mirrored;
  ShadeInputs inputs;
  const auto by_light = maps_for(
      drawing, any_shadows(layers.set()) ? lights_with_maps(pipeline.scene, -1) : std::vector<int>{});
  inputs.shadow_maps = by_light;
  inputs.kept = chunker::before_mirror(frame, mirror.point, mirror.normal);
  mirrored.picture = chunker::render(prepared, chunker::mirrored_frame(frame, mirror.point, mirror.normal),
                                     parts_before(drawing, layer, mirror), pipeline.settings.view.display_px,
                                     wide, pipeline.settings.render, inputs);
  mirrored.picture_from_screen = *picture_from_screen;
  return mirrored;
}

// --- What a sprite holds ---

/// Parts, and what their terms look up.
struct Contents {
  std::vector<int> parts;
  ShadeTerm term = ShadeTerm::Full;
  int light = -1;
  chunker::LightsHeld lights = chunker::LightsHeld::All;
  bool shadows = false;
  std::vector<const Layer*> mirrors;
  std::vector<chunker::TextureBlend> blends;
};

/// The factors with which the compositor blends the textures of `base` at a time, if it does.
void add_blend(const LayerSet& set, const Layer& base, double time_s, Contents& contents) {
  if constexpr (!kTextureLayers) return;
  for_each_shade(set, base.id, [&](const Layer& shade) {
    if (shade.kind != LayerKind::Texture) return;
    const float first = multipliers_at(base, time_s).color.x, second = multipliers_at(shade, time_s).color.x;
    contents.blends.push_back({{first, second}, base.parts});
  });
}

/// All terms of some geometry layers together.
Contents all_terms_of(const LayerSet& set, std::span<const int> geometry_layers, double time_s) {
  Contents contents;
  const auto hold = [&](const Layer& layer) {
    contents.shadows = contents.shadows || (kShadows && layer.holds.shadows);
    if (kMirrors && layer.holds.reflection) contents.mirrors.push_back(&layer);
  };
  for (const int id : geometry_layers) {
    const Layer& layer = set.layers[id];
    contents.parts.insert(contents.parts.end(), layer.parts.begin(), layer.parts.end());
    hold(layer);
    for_each_shade(set, id, hold);
    add_blend(set, layer, time_s, contents);
  }
  return contents;
}

Contents contents_of(const LayerSet& set, const Layer& layer, double time_s) {
  if (layer.is_aggregate()) {
    Contents contents = all_terms_of(set, layer.members, time_s);
    contents.parts = layer.parts;  // in their own order
    return contents;
  }
  const bool shadows = kShadows && layer.holds.shadows;
  return {layer.parts, term_of(layer), layer.light, lights_of(layer), shadows, mirrors_in(set, layer), {}};
}

/// What drawing `contents` looks up, kept as long as it is drawn.
class LookedUp {
 public:
  LookedUp(const Drawing& drawing, const Contents& contents, const SpritePlacement& placement) {
    inputs_.term = contents.term;
    inputs_.light = contents.light;
    inputs_.lights = contents.lights;
    inputs_.texture_blends = contents.blends;
    if (contents.shadows)
      by_light_ = maps_for(drawing, lights_with_maps(drawing.pipeline.scene, contents.light));
    inputs_.shadow_maps = by_light_;
    for (const Layer* mirror : contents.mirrors)
      mirrored_.push_back(draw_mirrored(drawing, *mirror, placement));
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

chunker::LinearImage draw_linear(const Drawing& drawing, const Contents& contents,
                                 const SpritePlacement& placement) {
  const LookedUp looked_up(drawing, contents, placement);
  const Settings& settings = drawing.pipeline.settings;
  return chunker::render_linear(drawing.prepared, drawing.frame, contents.parts, settings.view.display_px,
                                placement, settings.render, looked_up.inputs());
}

void add(const chunker::LinearImage& more, chunker::LinearImage& sum) {
  sum.counters += more.counters;
  for (std::size_t i = 0; i < sum.texels.size(); ++i) {
    chunker::LinearColor& c = sum.texels[i];
    const chunker::LinearColor& d = more.texels[i];
    c = {c.r + d.r, c.g + d.g, c.b + d.b, c.a};
  }
}

/// What shadows leave of a surface, for the extended compositor: the ratio of two pictures.
chunker::LinearImage draw_what_is_left(const Drawing& drawing, const Layer& layer,
                                       const SpritePlacement& placement) {
  using chunker::LightsHeld;
  const ShadeTerm term = layer.factored.specular ? ShadeTerm::Base : ShadeTerm::Full;
  Contents surface{layer.parts, term, -1, LightsHeld::All, false, {}, {}};
  const chunker::LinearImage whole = draw_linear(drawing, surface, placement);
  if (layer.shadows_as == layers::ShadowsAs::Atop)
    return darkness_atop(
        draw_linear(drawing, {layer.parts, ShadeTerm::Shadow, layer.light, LightsHeld::All, true, {}, {}},
                    placement),
        whole);
  surface.lights = LightsHeld::Unmapped;
  chunker::LinearImage seen = draw_linear(drawing, surface, placement);
  surface.lights = LightsHeld::One;
  surface.shadows = true;
  for (const int light : lights_with_maps(drawing.pipeline.scene, -1)) {
    surface.light = light;
    add(draw_linear(drawing, surface, placement), seen);
  }
  return left_of_light(seen, whole);
}

bool is_ratio(const Layer& layer) {
  return kShadows && layer.kind == LayerKind::Shadow && layer.shadows_as &&
         needs_registers(*layer.shadows_as);
}

/// `render`: chunker::render or render_late.
chunker::RenderResult draw(const Drawing& drawing, const Contents& contents, const SpritePlacement& placement,
                           decltype(chunker::render)* render = &chunker::render) {
  const LookedUp looked_up(drawing, contents, placement);
  const Settings& settings = drawing.pipeline.settings;
  chunker::RenderResult result =
      render(drawing.prepared, drawing.frame, contents.parts, settings.view.display_px, placement,
             settings.render, looked_up.inputs());
  looked_up.add_passes(result.counters);
  return result;
}

}  // namespace

chunker::RenderResult draw_layer(const Drawing& drawing, const Layer& layer,
                                 const SpritePlacement& placement) {
  if (is_ratio(layer)) {
    const chunker::LinearImage image = draw_what_is_left(drawing, layer, placement);
    return {chunker::encode_sprite(image), image.counters};
  }
  return draw(drawing, contents_of(drawing.layers.set(), layer, drawing.frame.time_s), placement);
}

chunker::RenderResult draw_layer_late(const Drawing& drawing, const Layer& layer,
                                      const SpritePlacement& placement) {
  if (is_ratio(layer)) return draw_layer(drawing, layer, placement);
  return draw(drawing, contents_of(drawing.layers.set(), layer, drawing.frame.time_s), placement,
              &chunker::render_late);
}

chunker::RenderedChunks draw_layer_chunks(const Drawing& drawing, const Layer& layer,
                                          const SpritePlacement& placement, const std::vector<int>& places) {
  const Contents contents = contents_of(drawing.layers.set(), layer, drawing.frame.time_s);
  const LookedUp looked_up(drawing, contents, placement);
  const Settings& settings = drawing.pipeline.settings;
  return chunker::render_chunks(drawing.prepared, drawing.frame, contents.parts, settings.view.display_px,
                                placement, places, settings.render, looked_up.inputs());
}

chunker::LinearImage draw_layer_linear(const Drawing& drawing, const Layer& layer,
                                       const SpritePlacement& placement, std::optional<layers::vec2> blend) {
  if (is_ratio(layer)) return draw_what_is_left(drawing, layer, placement);
  Contents contents = contents_of(drawing.layers.set(), layer, drawing.frame.time_s);
  if (blend) contents.blends = {{*blend, layer.parts}};
  return draw_linear(drawing, contents, placement);
}

std::vector<chunker::TermImage> draw_terms(const Drawing& drawing, const Layer& layer,
                                           const SpritePlacement& placement, chunker::BasePasses base) {
  const Settings& settings = drawing.pipeline.settings;
  const Contents contents = contents_of(drawing.layers.set(), layer, drawing.frame.time_s);
  const LookedUp looked_up(drawing, contents, placement);
  return chunker::render_terms(drawing.prepared, drawing.frame, contents.parts, settings.view.display_px,
                               placement, settings.render, looked_up.inputs(), base);
}

chunker::RenderResult draw_in_one_pass(const Drawing& drawing, std::span<const int> geometry_layers,
                                       const SpritePlacement& placement) {
  Contents contents = all_terms_of(drawing.layers.set(), geometry_layers, drawing.frame.time_s);
  std::erase_if(contents.parts, [&](int part) {
    return drawing.frame.scene->parts[part].is_seam || (drawing.seen && !(*drawing.seen)[part]);
  });
  return draw(drawing, contents, placement);
}

chunker::DepthRenderResult draw_with_depth(const Drawing& drawing, const std::vector<int>& parts,
                                           std::span<const std::uint32_t> numbers) {
  std::vector<int> surfaces;
  for (const Layer& layer : drawing.layers)
    if (layer.base < 0 && !layer.is_aggregate()) surfaces.push_back(layer.id);
  Contents contents = all_terms_of(drawing.layers.set(), surfaces, drawing.frame.time_s);
  contents.parts = parts;
  const Settings& settings = drawing.pipeline.settings;
  const LookedUp looked_up(drawing, contents, {});
  return chunker::render_with_depth(drawing.prepared, drawing.frame, parts, numbers, settings.view.display_px,
                                    settings.render, looked_up.inputs());
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
