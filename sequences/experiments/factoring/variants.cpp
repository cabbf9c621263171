// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/variants.h"

#include <algorithm>

#include "chunker/sampling.h"
#include "sequences/experiments/effect_removal.h"

namespace talisman::sequences {
namespace {

using layers::Effect;
using layers::Layer;
using layers::LayerPreferences;

/// What the compositor is told of one of the layer's two textures differs from what the materials say.
bool is_blended_otherwise(const layers::Scene& scene, const Layer& layer) {
  const bool is_second_light =
      layer.kind == layers::LayerKind::Light && layer.factored.second_texture && layer.holds.second_texture;
  const bool second = layer.kind == layers::LayerKind::Texture || is_second_light;
  const auto differs = [&](int part) {
    const int material = scene.parts[part].material;
    if (material < 0 || scene.materials[material].texture2 < 0) return false;
    const layers::vec2 blend = scene.materials[material].texture_blend;
    const double said = second ? blend.y : blend.x;
    return std::any_of(layer.gain.values.begin(), layer.gain.values.end(),
                       [said](double gain) { return gain != said; });
  };
  return std::any_of(layer.parts.begin(), layer.parts.end(), differs);
}

void make_full(layers::LayerSpec& spec, ShadeResolution shades) {
  spec.preferences.resolution_scale = 1;
  spec.preferences.motion_blur = 0;
  layers::ShadingSpec& shading = spec.shading;
  for (auto* term : {&shading.shadows, &shading.specular, &shading.reflection, &shading.textures}) {
    if (!*term) continue;
    const double own_scale = (*term)->resolution_scale;
    *term = spec.preferences;
    if (shades == ShadeResolution::Own) (*term)->resolution_scale = own_scale;
  }
}

}  // namespace

bool is_factored(const Sequence& sequence) {
  const auto& all = sequence.layers.layers;
  return std::any_of(all.begin(), all.end(), [](const Layer& layer) { return layer.base >= 0; });
}

Variant unfactored(const Variant& variant) {
  Variant whole = variant;
  for (const Effect effect :
       {Effect::TextureLayers, Effect::SpecularLayer, Effect::ReflectionLayer, Effect::ShadowLayer})
    whole = without_effect(whole, effect);
  return whole;
}

bool blends_over_time(const Sequence& sequence) {
  const auto& all = sequence.layers.layers;
  return std::any_of(all.begin(), all.end(),
                     [&](const Layer& layer) { return is_blended_otherwise(*sequence.scene, layer); });
}

Variant without_reuse(const Variant& variant) {
  Variant fresh = variant;
  fresh.settings.regulator.policy = regulator::Policy::Reference;
  return fresh;
}

Variant with_shadows_as(const Variant& variant, std::optional<layers::ShadowsAs> as) {
  Variant changed = variant;
  for (layers::LayerSpec& spec : changed.sequence.layer_specs) {
    std::optional<layers::ShadowsAs>& own = spec.shading.shadows_as;
    if (as)
      own = as;
    else if (own && needs_registers(*own))
      own.reset();
    if (as == layers::ShadowsAs::Multiply) spec.shading.textures.reset();
  }
  factor_again(changed);
  changed.settings.compositor = as && needs_registers(*as) ? Compositor::Extended : Compositor::Talisman;
  return changed;
}

Variant texel_on_pixel(const Variant& variant, ShadeResolution shades) {
  Variant flush = without_reuse(variant);
  for (layers::LayerSpec& spec : flush.sequence.layer_specs) make_full(spec, shades);
  flush.sequence.layers = layers::factor(*flush.sequence.scene, flush.sequence.layer_specs);
  Settings& settings = flush.settings;
  settings.placement.min_rotation_gain = 1;
  settings.placement.resolution_scale = 1;
  settings.placement.max_sprite_px = chunker::kMaxSpriteSide;
  settings.compression.reset();
  return flush;
}

}  // namespace talisman::sequences
