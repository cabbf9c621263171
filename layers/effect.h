// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which effects are there, and which of them does this build have?
///
/// A build may leave effects out (CMake variable TALISMAN_WITHOUT, a list of names). What is left out is gone
/// from the machine code: where an effect is decided on at run time, `is_built` is asked first, and since it
/// is a constant the compiler drops the branch, the call and what hangs on it. That is how it is measured
/// that an effect which a scene does not call for costs nothing: the build that has it and the one that has
/// not run that scene in the same time (tests/bench/effect_builds).
///
/// A scene that calls for an effect that the build lacks is refused before the first frame
/// (sequences/commands/missing_effects.h); what the libraries draw of it then is not defined.

#include <array>
#include <cstddef>
#include <string_view>

namespace talisman::layers {

enum class Effect {
  Texture,            ///< some drawn part has a textured material
  MipFilter,          ///< the same textures, filtered when minified, unless the run asks for none
  Lighting,           ///< some drawn part is lit: normals and lights are evaluated
  SpecularHighlight,  ///< some lit material has specular > 0
  Translucency,       ///< opacity < 1 or a texture with alpha
  Skinning,           ///< some drawn part has a skin
  LayerResolution,    ///< some layer asks for a resolution other than the display's
  MotionBlur,         ///< some layer has an open shutter: sampled along its motion
  SpriteCompression,  ///< the run keeps its sprites compressed
  VisibilitySort,     ///< some layers can overlap, and the author's groups do not order them
  ColorWarp,    ///< the light on some layer can change: colour warp and photometric fiducial [LS97 4.3, 5.2]
  ShadowMap,    ///< some light casts shadows, something casts and something receives: a pass per light
  ShadowLayer,  ///< … and some layer factors them: black sprites that darken their base
  SpecularLayer,    ///< some layer factors its highlights
  ReflectionMap,    ///< a flat layer mirrors others: a pass with the mirrored camera for each of its renders
  ReflectionLayer,  ///< … and factors the mirrored picture
  TextureLayers,    ///< some layer factors the second texture of its material
  EmissiveMap,      ///< some lit material's emission has a texture
  Morphing,         ///< some drawn part has morph targets
  LightFalloff,     ///< some light fades with distance
  NormalMap,        ///< some lit part has a normal texture and tangents
  MovingPicture,    ///< some drawn part shows an image sequence or a video
  Predictive,       ///< the run's policy: words of motion, and buffers with depth that are joined
};
inline constexpr std::array kAllEffects = {
    Effect::Texture,           Effect::MipFilter,      Effect::Lighting,        Effect::SpecularHighlight,
    Effect::Translucency,      Effect::Skinning,       Effect::LayerResolution, Effect::MotionBlur,
    Effect::SpriteCompression, Effect::VisibilitySort, Effect::ColorWarp,       Effect::ShadowMap,
    Effect::ShadowLayer,       Effect::SpecularLayer,  Effect::ReflectionMap,   Effect::ReflectionLayer,
    Effect::TextureLayers,     Effect::EmissiveMap,    Effect::Morphing,        Effect::LightFalloff,
    Effect::NormalMap,         Effect::MovingPicture,  Effect::Predictive};

/// In the order of kAllEffects.
inline constexpr std::array<std::string_view, kAllEffects.size()> kEffectNames = {
    "texture",          "mip_filter",       "lighting",     "specular_highlight", "translucency",
    "skinning",         "layer_resolution", "motion_blur",  "sprite_compression", "visibility_sort",
    "color_warp",       "shadow_map",       "shadow_layer", "specular_layer",     "reflection_map",
    "reflection_layer", "texture_layers",   "emissive_map", "morphing",           "light_falloff",
    "normal_map",       "moving_picture",   "predictive"};

/// "texture", "mip_filter", …
constexpr std::string_view name(Effect effect) { return kEffectNames[static_cast<std::size_t>(effect)]; }

/// A set of effects, one entry per effect.
using EffectSet = std::array<bool, kAllEffects.size()>;

}  // namespace talisman::layers
