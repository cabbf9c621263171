// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What would this sequence be if nothing called for one of its effects?
///
/// `without_effect` changes as little else as it can; what must go along:
///
///   texture             surfaces keep the mean colour and the mean opacity of their textures; mip_filter,
///                       texture_layers, emissive_map, normal_map and moving_picture go too
///   mip_filter          the finest level of the textures, filtered bilinearly
///   lighting            materials are unlit: their base colour as it is. Highlights, shadows, emission, the
///                       falloff of lamps, normal maps and the colour warp go too, and the shade layers that held them
///   specular_highlight  specular_layer goes too
///   translucency        opacity is 1 and textures have no alpha. Layers that cast no shadow still cast none
///   skinning            parts keep the pose of the first frame and follow the node that carries them
///   emissive_map        emission has the mean colour of its texture
///   normal_map          surfaces have the normals of their vertices
///   moving_picture      image sequences and videos stand still at their first frame
///   morphing            parts keep the shape of the first frame
///   light_falloff       lamps are everywhere as bright as they are at 1 m
///   layer_resolution    all sprites, also of shade layers, at the display's resolution
///   motion_blur         all shutters closed
///   sprite_compression  sprites are kept as they are
///   predictive          policy threshold, with the same thresholds
///   visibility_sort     each layer has a group of its own, in the order of the first frame: no sort, no pair
///                       of the author, no merging. Layers that are out of view then come last of their
///                       group, in the author's order
///   color_warp          neither colour warp nor a threshold of the light
///   shadow_map          no light casts shadows; shadow_layer goes too
///   reflection_map      nothing mirrors; reflection_layer goes too
///   shadow_layer, specular_layer, reflection_layer, texture_layers
///                       the term stays in the sprite of its surface, and so do those other terms of that
///                       surface that cannot have a sprite of their own then: highlights and second texture
///                       under a shadow or a reflection that is not factored (layers/shading.h). Without
///                       texture_layers a blend over time stands still, at the material's texture_blend
///
/// An effect that is not called for is taken from nothing: the result is as it was given.

#include "sequences/experiments/variant.h"

namespace talisman::sequences {

/// Cost: a copy of the scene where the scene is changed, and the factoring of its layers.
Variant without_effect(const Variant& given, layers::Effect effect);

/// The layers again, after scene or specs have changed; pairs of the author's order stay those of the same names.
void factor_again(Variant& variant);

}  // namespace talisman::sequences
