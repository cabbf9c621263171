// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "chunker/shade.h"
#include "chunker/shadow_map.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/spot_cone.h"
#include "layers/vectors.h"

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::vec3;

bool finite(const layers::LightState& light) {
  return layers::is_finite(light.position) && layers::is_finite(light.direction) &&
         layers::is_finite(dvec3(light.color)) && std::isfinite(light.inner_cone_rad) &&
         std::isfinite(light.outer_cone_rad);
}

bool wants_shadows(ShadeTerm term) {
  return term == ShadeTerm::Full || term == ShadeTerm::Shadow || term == ShadeTerm::Specular;
}

/// The place of the light's map in the set, or -1.
int add_shadow(const ShadeInputs& inputs, std::size_t light, LightSet& set) {
  if constexpr (!layers::is_built(layers::Effect::ShadowMap)) return -1;
  if (!(wants_shadows(inputs.term) || inputs.lights == LightsHeld::One) || light >= inputs.shadow_maps.size())
    return -1;
  const bool other = inputs.light >= 0 && static_cast<std::size_t>(inputs.light) != light;
  if (inputs.term == ShadeTerm::Shadow && other) return -1;
  const ShadowMap* map = inputs.shadow_maps[light];
  if (map == nullptr || map->empty()) return -1;
  TALISMAN_CHECK_LT(set.shadows, layers::kMaxShadowLights);
  set.shadow_maps[set.shadows] = map;
  return set.shadows++;
}

LightSet::Fading fading(const layers::LightState& light) {
  LightSet::Fading fading;
  if (!layers::is_built(layers::Effect::LightFalloff) || !light.falls_off()) return fading;
  fading.any = true;
  fading.constant = static_cast<float>(light.attenuation.x);
  fading.linear = static_cast<float>(light.attenuation.y);
  fading.quadratic = static_cast<float>(light.attenuation.z);
  if (light.range_m > 0) fading.per_range2 = static_cast<float>(1 / (light.range_m * light.range_m));
  return fading;
}

LightSet::Spot spot(const layers::LightState& light, const dvec3& eye, int shadow) {
  constexpr double kSharpest = 1e-6;  // a cone without a soft edge still has a finite slope
  const double outer = std::cos(light.outer_cone_rad), inner = std::cos(light.inner_cone_rad);
  LightSet::Spot result;
  result.position = float4(vec3(light.position - eye));
  result.color = float4(light.color);
  result.axis = normalized3(float4(vec3(light.direction)));
  result.cos_outer = static_cast<float>(outer);
  result.inverse_width = static_cast<float>(1 / std::max(inner - outer, kSharpest));
  const layers::ConeRamp ramp = layers::cone_ramp(light);
  result.ramp = static_cast<float>(ramp.constant);
  result.ramp_slope = static_cast<float>(ramp.slope);
  result.shadow = shadow;
  result.fading = fading(light);
  return result;
}

}  // namespace

LightSet light_set(const layers::SceneFrame& frame, const ShadeInputs& inputs) {
  LightSet set;
  set.eye = dvec3(frame.camera.world_from_camera[3]);
  if constexpr (!layers::is_built(layers::Effect::Lighting)) return set;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const layers::LightState& light = frame.lights[i];
    if (!finite(light)) continue;
    const bool other = inputs.light >= 0 && static_cast<std::size_t>(inputs.light) != i;
    const bool one = inputs.term == ShadeTerm::Specular || inputs.lights == LightsHeld::One;
    if (one && other) continue;
    if (inputs.lights == LightsHeld::Unmapped && light.casts_shadow) continue;
    const Float4 color = float4(light.color);
    switch (light.kind) {
      case layers::Light::Kind::Ambient:
        set.ambient += color;
        break;
      case layers::Light::Kind::Directional:
        set.directional.push_back(
            {normalized3(float4(vec3(-light.direction))), color, add_shadow(inputs, i, set)});
        break;
      case layers::Light::Kind::Point:
        set.point.push_back(
            {float4(vec3(light.position - set.eye)), color, add_shadow(inputs, i, set), fading(light)});
        break;
      case layers::Light::Kind::Spot:
        set.spot.push_back(spot(light, set.eye, add_shadow(inputs, i, set)));
        break;
    }
  }
  return set;
}

}  // namespace talisman::chunker
