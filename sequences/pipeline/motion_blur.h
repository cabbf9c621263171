// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The effect *motion blur* [LS97 3.4, Fig. 11]: how far apart are the samples of a layer's sprite along its
/// motion?
///
///   v        mean motion of the characteristic points on the display, from this frame to the next, px
///   density  1 / (|v| · shutter), at most 1 and at least 1/16, along v; across it that of the display
///
/// A texel is then as long as the way that the layer goes while the shutter is open. Motion is that of the
/// sequence, not of the extents, so every policy samples a layer alike. Nothing here is called for layers
/// without the preference.

#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

struct MotionSampling {
  layers::dvec2 motion_px{0, 0};
  double density = 1;  ///< 1: at rest, or slower than a pixel while the shutter is open
};

/// Cost: the capture of the layer one frame later (some µs, scene.at included).
MotionSampling motion_sampling(const Pipeline& pipeline, const LayerTable& layers,
                               const layers::LayerState& now);

/// Adds the blur of the layer at `now` to the options of its placement.
void apply_motion_blur(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& now,
                       layers::PlacementOptions& placement);

/// A sprite of `then` has another blur than one of `now` would have. It is then not identical, and the ratio
/// of the two densities counts as magnification (a blur that has ended) or minification (one that is
/// missing).
void judge_motion_blur(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& then,
                       const layers::LayerState& now, regulator::LayerAssessment& assessment);

}  // namespace talisman::sequences
