// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The effect *motion blur* [LS97 3.4, Fig. 11]: how far apart are the samples of a layer's sprite along its
/// motion?
///
///   v        mean motion of the characteristic points on the display, from this frame to the next, px; in the
///            last frame of a sequence, which has no next, from the one before; and where motion ahead is
///            predicted, to the next frame as it is expected
///   density  1 / (|v| · shutter), at most 1 and at least 1/16, along v; across it that of the display
///
/// A texel is then as long as the way that the layer goes while the shutter is open. Motion is that of the
/// sequence, not of the extents, so every policy samples a layer alike. Nothing here is called for layers
/// without the preference.

#include <span>

#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

struct MotionSampling {
  layers::dvec2 motion_px{0, 0};
  double density = 1;  ///< 1: at rest, or slower than a pixel while the shutter is open
};

/// Of the motion that the state was captured with.
MotionSampling motion_sampling(const LayerTable& layers, const layers::LayerState& now);

/// The frame towards or from which the motion at `frame` is measured.
int other_frame(const Pipeline& pipeline, int frame);

/// Notes in the states of all layers with an open shutter how far they move: `other` is the scene at
/// other_frame. Nothing is done for other layers. Cost: the capture of those layers (some µs each).
void capture_motion(const Pipeline& pipeline, const LayerTable& layers, const layers::SceneFrame& other,
                    int frame, std::span<layers::LayerState> states);
bool any_shutter_open(const LayerTable& layers);

/// Adds the blur of the layer at `now` to the options of its placement.
void apply_motion_blur(const LayerTable& layers, const layers::LayerState& now,
                       layers::PlacementOptions& placement);

/// A sprite of `then` has another blur than one of `now` would have. It is then not identical, and the ratio
/// of the two densities counts as magnification (a blur that has ended) or minification (one that is
/// missing).
void judge_motion_blur(const LayerTable& layers, const layers::LayerState& then,
                       const layers::LayerState& now, regulator::LayerAssessment& assessment);

}  // namespace talisman::sequences
