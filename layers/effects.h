// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which effects does a scene call for, and why?
///
/// What a scene does not use costs nothing: no pass, no memory, no counter. This table is computed from the
/// scene, its layers and the options of the run alone, before anything is drawn, and names for every effect
/// the element that calls for it or that none does.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "layers/effect.h"
#include "layers/layer.h"

namespace talisman::layers {

struct EffectCall {
  Effect effect = Effect::Texture;
  bool called = false;
  std::string why;          ///< "material 'hull' has texture 'gl-14.tga'" or "no material has a texture"
  std::vector<int> layers;  ///< ids of the layers that use it, ascending
};

/// The effects that a run asks for, whatever the scene.
struct RunEffects {
  std::optional<int> compression_quality;  ///< empty: sprites are kept as they are
  bool mip_filter = true;                  ///< false: the run looks textures up in their finest level only
  bool per_pixel = true;      ///< false: surfaces are shaded flat or at vertices, and have no normal maps
  bool predictive = false;    ///< the run joins buffers with depth, and has no sprites
  bool follows_light = true;  ///< false: neither a colour warp nor a fiducial of the light is asked for
};

/// Are there two layers that the author's groups do not order? Cost: O(layers).
bool calls_for_visibility_sort(std::span<const Layer> layers);

/// How a shadow map comes to be: does its light, or anything that casts into it, move?
struct ShadowMapUse {
  int light = -1;
  bool drawn_once = false;  ///< neither moves
  std::string why;          ///< "light 'sun': static, drawn once"
};

/// One entry per light whose shadow map some layer looks up. Cost: O(casting parts · depth).
std::vector<ShadowMapUse> shadow_maps_called_for(const Scene& scene, std::span<const Layer> layers);

/// One entry per effect, in the order of kAllEffects. Parts that no layer takes do not count. Cost: O(parts).
std::vector<EffectCall> effects_called_for(const Scene& scene, std::span<const Layer> layers,
                                           const RunEffects& run = {});

}  // namespace talisman::layers
