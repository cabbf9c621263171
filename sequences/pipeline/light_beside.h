// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far does the light of a Light layer fall beside the surface that it belongs to?
///
/// Sprites of both are carried by warps of their own, from the instants as of which each was drawn. With p̂ the
/// characteristic points on the display at those instants and W the warps,
///
///   e = maxᵢ ‖W_base p̂ᵢ,base - W_light p̂ᵢ,light‖
///
/// over the points that are in view in all three states, pixels. By the triangle inequality e is at most the
/// sum of what the geometric fiducial says of the two sprites; that sum is given where no point is in view in
/// all three. 0 where both were drawn as of one instant and are shown alike.

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// `layer` is a Light layer with a sprite, and so is its base; `now` is its base's state. Cost: O(characteristic
/// points).
double light_beside_px(const PipelineState& state, const FrameReport& report, const layers::Layer& layer,
                       const layers::LayerState& now);

}  // namespace talisman::sequences
