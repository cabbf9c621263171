// SPDX-License-Identifier: Apache-2.0
#include "layers/effects.h"

#include <algorithm>

#include "layers/animation.h"
#include "layers/light_change.h"

namespace talisman::layers {

namespace {

bool is_zero(const vec3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

bool has_lights(const Scene& scene) { return !scene.lights.empty(); }

/// Why this part calls for the effect; empty if it does not.
std::string call_of(const Scene& scene, const Part& part, Effect effect) {
  const Material* material = part.material >= 0 ? &scene.materials[part.material] : nullptr;
  const std::string material_name = material ? "material '" + material->name + "'" : "";
  const Texture* texture = material && material->texture >= 0 ? &scene.textures[material->texture] : nullptr;
  switch (effect) {
    case Effect::Texture:
    case Effect::MipFilter:
      if (texture) return material_name + " has texture '" + texture->name + "'";
      break;
    case Effect::Lighting:
      if (material && !material->unlit && has_lights(scene)) return material_name + " is lit";
      break;
    case Effect::SpecularHighlight:
      if (material && !material->unlit && has_lights(scene) && !is_zero(material->specular))
        return material_name + " has specular > 0";
      break;
    case Effect::Translucency:
      if (material && material->opacity < 1) return material_name + " has opacity < 1";
      if (texture && texture->has_alpha) return "texture '" + texture->name + "' has alpha";
      break;
    case Effect::Skinning:
      if (part.skin >= 0) return "part '" + part.name + "' has a skin";
      break;
    case Effect::LayerResolution:
    case Effect::MotionBlur:
    case Effect::SpriteCompression:
    case Effect::VisibilitySort:
    case Effect::ColorWarp:
      break;  // asked for by layers and runs, not by parts
  }
  return {};
}

const char* name_of(OrderGroup group) {
  return group == OrderGroup::Background   ? "background"
         : group == OrderGroup::Foreground ? "foreground"
                                           : "normal";
}

/// The first other layer of the same group; null: the groups order `layer` against all others.
const Layer* first_rival(std::span<const Layer> layers, const Layer& layer) {
  for (const Layer& other : layers)
    if (other.id != layer.id && other.group == layer.group) return &other;
  return nullptr;
}

std::string call_of(const Scene& scene, std::span<const Layer> layers, const Layer& layer, Effect effect,
                    const RunEffects& run, std::span<const int> carriers) {
  if (effect == Effect::ColorWarp) return light_change_of(scene, layer, carriers).why;
  if (effect == Effect::SpriteCompression)
    return run.compression_quality ? "the run asks for quality " + std::to_string(*run.compression_quality)
                                   : "";
  if (effect == Effect::MotionBlur)
    return layer.preferences.motion_blur > 0 ? "layer '" + layer.name + "' has motion_blur > 0" : "";
  if (effect == Effect::VisibilitySort) {
    const Layer* rival = first_rival(layers, layer);
    return rival ? "layers '" + layer.name + "' and '" + rival->name + "' of group " + name_of(layer.group) +
                       " can overlap"
                 : "";
  }
  if (effect == Effect::LayerResolution)
    return layer.preferences.resolution_scale != 1 ? "layer '" + layer.name + "' has its own resolution" : "";
  for (const int part : layer.parts)
    if (std::string why = call_of(scene, scene.parts[part], effect); !why.empty()) return why;
  return {};
}

std::string why_not(const Scene& scene, Effect effect) {
  switch (effect) {
    case Effect::Texture:
    case Effect::MipFilter:
      return "no material has a texture";
    case Effect::Lighting:
      return has_lights(scene) ? "no material is lit" : "the scene has no light";
    case Effect::SpecularHighlight:
      return "no lit material has specular > 0";
    case Effect::Translucency:
      return "every material is opaque";
    case Effect::Skinning:
      return "no part has a skin";
    case Effect::LayerResolution:
      return "every layer has the display's resolution";
    case Effect::MotionBlur:
      return "no layer has motion_blur > 0";
    case Effect::SpriteCompression:
      return "the run does not ask for it";
    case Effect::VisibilitySort:
      return "no two layers are in one group";
    case Effect::ColorWarp:
      return "no light moves against a lit layer, and no highlight moves";
  }
  return {};
}

}  // namespace

std::string_view name(Effect effect) {
  switch (effect) {
    case Effect::Texture:
      return "texture";
    case Effect::MipFilter:
      return "mip_filter";
    case Effect::Lighting:
      return "lighting";
    case Effect::SpecularHighlight:
      return "specular_highlight";
    case Effect::Translucency:
      return "translucency";
    case Effect::Skinning:
      return "skinning";
    case Effect::LayerResolution:
      return "layer_resolution";
    case Effect::MotionBlur:
      return "motion_blur";
    case Effect::SpriteCompression:
      return "sprite_compression";
    case Effect::VisibilitySort:
      return "visibility_sort";
    case Effect::ColorWarp:
      return "color_warp";
  }
  return "?";
}

bool calls_for_visibility_sort(std::span<const Layer> layers) {
  for (const Layer& layer : layers)
    if (first_rival(layers, layer)) return true;
  return false;
}

std::vector<EffectCall> effects_called_for(const Scene& scene, std::span<const Layer> layers,
                                           const RunEffects& run) {
  const std::vector<int> carriers = moving_carriers(scene);
  std::vector<EffectCall> table;
  for (const Effect effect : kAllEffects) {
    EffectCall call{effect, false, why_not(scene, effect), {}};
    for (const Layer& layer : layers) {
      std::string why = call_of(scene, layers, layer, effect, run, carriers);
      if (why.empty()) continue;
      if (!call.called) call.why = std::move(why);
      call.called = true;
      call.layers.push_back(layer.id);
    }
    table.push_back(std::move(call));
  }
  return table;
}

}  // namespace talisman::layers
