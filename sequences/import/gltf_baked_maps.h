// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Maps that our shading has not, put into the colour texture: metalness (pbr_surface.h, texel by texel) and
/// occlusion.
///
///   texel · (1 − m + 0.45 m²) · (1 − ½ strength (1 − occlusion))
///
/// Occlusion is meant for indirect light alone (glTF 2.0, 3.9.3); a colour texture darkens all light, so half of it
/// is taken.

#include "layers/scene.h"

namespace talisman::sequences {

struct MapsToBake {
  const layers::Texture* color = nullptr;      ///< null: white
  const layers::Texture* metallic = nullptr;   ///< its blue channel; null: 1
  const layers::Texture* occlusion = nullptr;  ///< its red channel; null: 1
  double metallic_factor = 0;                  ///< 0 … 1
  double occlusion_strength = 1;               ///< 0 … 1
};

/// As large as the largest of the maps along each side; looked up as the colour texture is, or as the first map.
/// Without a texel where no map changes anything. At least one map is given.
layers::Texture baked_maps(const MapsToBake& maps);

}  // namespace talisman::sequences
