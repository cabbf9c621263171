// SPDX-License-Identifier: Apache-2.0
#include "layers/effects.h"

#include <algorithm>

#include "layers/animation.h"
#include "layers/light_change.h"
#include "layers/moving_picture.h"
#include "layers/scene.h"
#include "layers/shading.h"
#include "layers/vectors.h"

namespace talisman::layers {

namespace {

bool has_lights(const Scene& scene) { return !scene.lights.empty(); }

bool has_emissive_map(const Material& material) {
  return !material.unlit && material.emissive_texture >= 0 && !is_zero(material.emissive);
}

/// Ambient light comes from everywhere: normals are not asked.
bool shows_normal_map(const Scene& scene, const Part& part) {
  const bool has_direction = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.kind != Light::Kind::Ambient;
  });
  return has_direction && has_normal_map(scene.materials[part.material], scene.meshes[part.mesh]);
}

/// The first texture that is looked up for the part; -1: none is.
int any_texture(const Scene& scene, const Part& part) {
  if (part.material < 0) return -1;
  const Material& material = scene.materials[part.material];
  if (material.texture >= 0) return material.texture;
  if (has_emissive_map(material)) return material.emissive_texture;
  return shows_normal_map(scene, part) ? material.normal_texture : -1;
}

std::string quoted_texture(const Scene& scene, int texture) {
  return "texture '" + scene.textures[texture].name + "'";
}

/// Who fades with distance, or nobody.
std::string fading_light(const Scene& scene) {
  for (const Light& light : scene.lights) {
    const bool local = light.kind == Light::Kind::Point || light.kind == Light::Kind::Spot;
    if (local && (light.attenuation != dvec3{1, 0, 0} || light.range_m > 0))
      return "light '" + light.name + "' fades with distance";
  }
  return {};
}

std::string call_of_moving_picture(const Scene& scene, const Part& part) {
  if (part.material < 0) return {};
  const Material& material = scene.materials[part.material];
  const int shown = moving_picture_of(scene, material);
  if (shown < 0) return {};
  const MovingPicture& picture = scene.moving_pictures[shown];
  return "material '" + material.name + "' shows " + std::to_string(picture.frames.size()) + " frames of '" +
         picture.name + "'";
}

/// Why this part calls for the effect; empty if it does not.
std::string call_of(const Scene& scene, const Part& part, Effect effect) {
  const Material* material = part.material >= 0 ? &scene.materials[part.material] : nullptr;
  const std::string material_name = material ? "material '" + material->name + "'" : "";
  const Texture* texture = material && material->texture >= 0 ? &scene.textures[material->texture] : nullptr;
  switch (effect) {
    case Effect::Texture:
    case Effect::MipFilter:
      if (const int any = any_texture(scene, part); any >= 0)
        return material_name + " has " + quoted_texture(scene, any);
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
      if (!scene.meshes[part.mesh].alphas.empty())
        return "part '" + part.name + "' has vertex colours with alpha";
      break;
    case Effect::Skinning:
      if (part.skin >= 0) return "part '" + part.name + "' has a skin";
      break;
    case Effect::Morphing:
      if (!scene.meshes[part.mesh].morphs.empty()) return "part '" + part.name + "' has morph targets";
      break;
    case Effect::EmissiveMap:
      if (material && has_emissive_map(*material))
        return material_name + " has emissive " + quoted_texture(scene, material->emissive_texture);
      break;
    case Effect::LightFalloff:
      if (!material || !material->unlit) return fading_light(scene);
      break;
    case Effect::NormalMap:
      if (material && shows_normal_map(scene, part))
        return material_name + " has normal " + quoted_texture(scene, material->normal_texture);
      break;
    default:
      break;  // asked for by layers, not by parts
  }
  return {};
}

std::string quoted(const char* what, const std::string& name) {
  return std::string(what) + " '" + name + "'";
}

std::string light_of(const Scene& scene, int light) {
  if (light < 0) return "all lights";
  const std::string& name = scene.lights[light].name;
  return name.empty() ? "light " + std::to_string(light) : quoted("light", name);
}

const char* name_of(OrderGroup group) {
  return group == OrderGroup::Background   ? "background"
         : group == OrderGroup::Foreground ? "foreground"
         : group == OrderGroup::Normal     ? "normal"
                                           : "of its own";
}

/// The first other layer of the same group; null: the groups order `layer` against all others. Shade layers
/// follow their bases.
const Layer* first_rival(std::span<const Layer> layers, const Layer& layer) {
  if (layer.base >= 0) return nullptr;
  for (const Layer& other : layers)
    if (other.id != layer.id && other.group == layer.group && other.base < 0) return &other;
  return nullptr;
}

std::string call_of_visibility_sort(std::span<const Layer> layers, const Layer& layer) {
  const Layer* rival = first_rival(layers, layer);
  return rival ? "layers '" + layer.name + "' and '" + rival->name + "' of group " + name_of(layer.group) +
                     " can overlap"
               : "";
}

/// "layer 'floor/specular' holds the highlights of its base"
std::string shade_call(const Layer& layer, LayerKind kind, const std::string& what) {
  return layer.kind == kind ? quoted("layer", layer.name) + " holds " + what : "";
}

/// "layer 'floor' mirrors 5 layers; one bounce: layer 'wall' reflects nothing in it"
std::string call_of_reflection(std::span<const Layer> layers, const Layer& layer) {
  if (!layer.holds.reflection) return {};
  std::string why =
      quoted("layer", layer.name) + " mirrors " + std::to_string(layer.reflected.size()) + " layers";
  for (const Layer& other : layers) {
    const int base = other.base < 0 ? other.id : other.base;
    if (other.holds.reflection && std::count(layer.reflected.begin(), layer.reflected.end(), base) > 0)
      return why + "; one bounce: " + quoted("layer", layers[base].name) + " reflects nothing in it";
  }
  return why;
}

/// What is asked of one layer, beside the layer itself.
struct Context {
  const Scene& scene;
  std::span<const Layer> layers;
  const RunEffects& run;
  std::vector<int> carriers;  ///< moving_carriers(scene)
};

/// What depends on the run's own wish as well.
bool run_allows(const RunEffects& run, Effect effect) {
  return effect == Effect::MipFilter ? run.mip_filter : effect == Effect::NormalMap ? run.per_pixel : true;
}

/// Asked for by the run alone.
std::string call_of(const RunEffects& run, Effect effect) {
  if (effect == Effect::Predictive) return run.predictive ? "the run's policy is predictive" : "";
  return run.compression_quality ? "the run asks for quality " + std::to_string(*run.compression_quality)
                                 : "";
}

std::string call_of(const Context& context, const Layer& layer, Effect effect) {
  const Scene& scene = context.scene;
  if (!run_allows(context.run, effect)) return {};
  switch (effect) {
    case Effect::LayerResolution:
      return layer.preferences.resolution_scale != 1 ? quoted("layer", layer.name) + " has its own resolution"
                                                     : "";
    case Effect::MotionBlur:
      return layer.preferences.motion_blur > 0 ? quoted("layer", layer.name) + " has motion_blur > 0" : "";
    case Effect::SpriteCompression:
    case Effect::Predictive:
      return call_of(context.run, effect);
    case Effect::VisibilitySort:
      return call_of_visibility_sort(context.layers, layer);
    case Effect::ColorWarp:
      return (layer.base < 0 || layer.kind == LayerKind::Light) && context.run.follows_light
                 ? light_change_of(scene, layer, context.carriers).why
                 : "";
    case Effect::ShadowMap:
      return layer.holds.shadows ? "shadows fall on " + quoted("layer", layer.name) : "";
    case Effect::ShadowLayer:
      if (layer.kind == LayerKind::Light)
        return shade_call(layer, LayerKind::Light, "the light of " + light_of(scene, layer.light));
      return layer.kind == LayerKind::Shadow
                 ? shade_call(layer, LayerKind::Shadow, "the shadows of " + light_of(scene, layer.light))
                 : "";
    case Effect::SpecularLayer:
      return shade_call(layer, LayerKind::Specular, "the highlights of its base");
    case Effect::ReflectionMap:
      return call_of_reflection(context.layers, layer);
    case Effect::ReflectionLayer:
      return shade_call(layer, LayerKind::Reflection, "the mirrored picture");
    case Effect::TextureLayers:
      return shade_call(layer, LayerKind::Texture, "the second texture of its base");
    default:
      break;
  }
  for (const int part : layer.parts)
    if (std::string why = effect == Effect::MovingPicture ? call_of_moving_picture(scene, scene.parts[part])
                                                          : call_of(scene, scene.parts[part], effect);
        !why.empty())
      return why;
  return {};
}

// --- Why not ---

bool any_layer(std::span<const Layer> layers, bool (*is_so)(const Layer&)) {
  return std::any_of(layers.begin(), layers.end(), is_so);
}

bool any_layer_part(const Scene& scene, std::span<const Layer> layers,
                    bool (*property)(const Scene&, const Part&)) {
  return std::any_of(layers.begin(), layers.end(),
                     [&](const Layer& layer) { return any_part(scene, layer, property); });
}

std::string why_no_shadow_map(const Scene& scene, std::span<const Layer> layers) {
  const bool casts = std::any_of(scene.lights.begin(), scene.lights.end(),
                                 [](const Light& light) { return light.casts_shadow; });
  if (scene.lights.empty()) return "the scene has no light";
  if (!casts) return "no light casts shadows";
  if (!any_layer_part(scene, layers, is_lit)) return "no part is lit, so none receives a shadow";
  return "no part casts a shadow on another layer";
}

std::string why_no_reflection(const Scene& scene, std::span<const Layer> layers) {
  for (const Layer& layer : layers)
    if (layer.base < 0 && any_part(scene, layer, is_reflecting)) {
      const std::string defect = reflection_defect(scene, layer);
      return quoted("layer", layer.name) + ": " + (defect.empty() ? "nothing else is there" : defect);
    }
  return "no material has reflectivity > 0";
}

/// Of an effect of shade layers: nothing calls for the term, or no layer factors it.
std::string why_no_shade_layer(const Scene& scene, std::span<const Layer> layers, Effect effect) {
  switch (effect) {
    case Effect::ShadowLayer:
      return any_layer(layers, [](const Layer& l) { return l.holds.shadows; })
                 ? "no layer factors its shadows: their sprites hold them"
                 : why_no_shadow_map(scene, layers);
    case Effect::SpecularLayer:
      if (!any_layer_part(scene, layers, is_highlighted)) return "no lit material has specular > 0";
      return "no layer with highlights factors them: its sprite holds them";
    case Effect::ReflectionLayer:
      return any_layer(layers, [](const Layer& l) { return l.holds.reflection; })
                 ? "no layer factors its reflection: its sprite holds it"
                 : why_no_reflection(scene, layers);
    default:
      return any_layer_part(scene, layers, has_second_texture)
                 ? "no layer factors its second texture: its sprite holds it"
                 : "no material has a second texture";
  }
}

std::string why_not(const Scene& scene, std::span<const Layer> layers, const RunEffects& run, Effect effect) {
  constexpr const char* kNotAsked = "the run does not ask for it";
  switch (effect) {
    case Effect::Texture:
    case Effect::MipFilter:
      return effect == Effect::Texture || run.mip_filter ? "no material has a texture" : kNotAsked;
    case Effect::Lighting:
      return has_lights(scene) ? "no material is lit" : "the scene has no light";
    case Effect::SpecularHighlight:
      return "no lit material has specular > 0";
    case Effect::Translucency:
      return "every material is opaque";
    case Effect::Skinning:
      return "no part has a skin";
    case Effect::EmissiveMap:
      return "no lit material has an emissive texture";
    case Effect::Morphing:
      return "no part has morph targets";
    case Effect::LightFalloff:
      return "no light fades with distance";
    case Effect::NormalMap:
      return run.per_pixel ? "no lit part has a normal texture and tangents"
                           : "the run does not shade per pixel";
    case Effect::MovingPicture:
      return "no material shows an image sequence or a video";
    case Effect::LayerResolution:
      return "every layer has the display's resolution";
    case Effect::MotionBlur:
      return "no layer has motion_blur > 0";
    case Effect::SpriteCompression:
    case Effect::Predictive:
      return kNotAsked;
    case Effect::VisibilitySort:
      return "no two layers are in one group";
    case Effect::ColorWarp:
      return run.follows_light ? "no light moves against a lit layer, and no highlight moves"
                               : "the run does not follow the light";
    case Effect::ShadowMap:
      return why_no_shadow_map(scene, layers);
    case Effect::ReflectionMap:
      return why_no_reflection(scene, layers);
    default:
      return why_no_shade_layer(scene, layers, effect);
  }
}

/// "light 'spot': drawn again when light or casters move; light 'sun': static, drawn once"
std::string why_of_shadow_maps(const Scene& scene, std::span<const Layer> layers) {
  std::string why;
  for (const ShadowMapUse& use : shadow_maps_called_for(scene, layers))
    why += (why.empty() ? "" : "; ") + use.why;
  return why;
}

bool moves(const Scene& scene, const Part& part) {
  if (is_animated(scene, part.node) || !scene.meshes[part.mesh].morphs.empty()) return true;
  if (part.skin < 0) return false;
  const Skin& skin = scene.skins[part.skin];
  return std::any_of(skin.joints.begin(), skin.joints.end(),
                     [&](int joint) { return is_animated(scene, joint); });
}

}  // namespace

bool calls_for_visibility_sort(std::span<const Layer> layers) {
  for (const Layer& layer : layers)
    if (first_rival(layers, layer)) return true;
  return false;
}

std::vector<ShadowMapUse> shadow_maps_called_for(const Scene& scene, std::span<const Layer> layers) {
  std::vector<ShadowMapUse> uses;
  const std::vector<int> casting = casting_parts(scene, layers);
  const bool casters_move =
      std::any_of(casting.begin(), casting.end(), [&](int part) { return moves(scene, scene.parts[part]); });
  for (std::size_t i = 0; i < scene.lights.size() && !casting.empty(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.casts_shadow) continue;
    ShadowMapUse use{static_cast<int>(i), false, light_of(scene, static_cast<int>(i))};
    use.drawn_once = !casters_move && (light.node < 0 || !is_animated(scene, light.node));
    use.why += use.drawn_once ? ": static, drawn once" : ": drawn again when light or casters move";
    uses.push_back(std::move(use));
  }
  return uses;
}

std::vector<EffectCall> effects_called_for(const Scene& scene, std::span<const Layer> layers,
                                           const RunEffects& run) {
  const Context context{scene, layers, run, moving_carriers(scene)};
  std::vector<EffectCall> table;
  for (const Effect effect : kAllEffects) {
    EffectCall call{effect, false, {}, {}};
    for (const Layer& layer : layers) {
      std::string why = call_of(context, layer, effect);
      if (why.empty()) continue;
      if (!call.called) call.why = std::move(why);
      call.called = true;
      call.layers.push_back(layer.id);
    }
    if (!call.called) call.why = why_not(scene, layers, run, effect);
    if (call.called && effect == Effect::ShadowMap) call.why = why_of_shadow_maps(scene, layers);
    table.push_back(std::move(call));
  }
  return table;
}

}  // namespace talisman::layers
