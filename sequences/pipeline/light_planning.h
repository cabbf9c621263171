// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers have their light and their faces followed, and what that says of an old sprite: the
/// photometric and the facing fiducials as `step` uses them. A layer on which the light cannot change costs
/// nothing.
///
/// Surfaces and light layers: fiducials/photometric.h. Shadow layers: fiducials/shade_strength.h. In an aggregate
/// (layers/aggregate.h) the renderer blends the textures that the compositor blends while the layers are apart; where
/// these blends change over time, k of k̂ in the old sprite,
///
///   F + max over members Σ |k - k̂| · max over points ‖C‖
///
/// which is an estimate: C holds both textures as the material blends them.

#include <vector>

#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The bound, equipped for what the options follow: with a surface if the light can change on the layer, with
/// the frames of the bodies where turned faces are regulated. Cost: once per layer and run; reads the
/// triangles and textures of layers on which the light can change.
layers::LayerBound following_light_and_faces(const Pipeline& pipeline, const layers::Layer& layer,
                                             layers::LayerBound bound);

/// Fills in Report::photometric, with the names of the lights, and Report::turned, of the layer `now.layer`.
void assess_light_and_faces(const Pipeline& pipeline, const LayerTable& layers,
                            const layers::LayerState& then, const layers::LayerState& now,
                            fiducials::Report& report);

/// "the shadow of 'rotor' in light 'key'", "its own shadow in light 'key'", "the highlight of light 2", "the
/// reflection of 'ship'": what has moved most over the layer.
std::string shade_in_words(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& now,
                           const fiducials::ShadeMotion& motion);

}  // namespace talisman::sequences
