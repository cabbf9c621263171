// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which sprites fade into fresh ones, and how far? [LS97 8] (regulator/plan.h, RegulatorOptions::blend_frames.)
///
/// A sprite that was carried by a warp in the frame before and is drawn again in frame f steps from its error to none.
/// With blend_frames = K it fades instead: in frame f + j, j = 0 … K - 1, the fresh sprite has the share
///
///   a = (j + 1) / (K + 1)
///
/// and the old one, carried on by a warp of its own, the rest. Both decisions are of the plan: no pixel is touched
/// here. What is shown is off by as much as the worse of the two, up to twice the geometric threshold, beyond which a
/// sprite does not fade (regulator/policies.h): that is the price of the remedy, and it is what the decision says. The third sprite (chunker/cross_fade.h)
/// fills as many texels as the fresh one has; they are part of the decision's cost.
///
/// A layer that is drawn every frame has no step to hide and does not fade; one that is drawn again while it fades
/// begins anew, from the sprite that was fresh.

#include <map>
#include <set>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The layer is about to be drawn again in `frame`: does what it shows fade out? To be called before its memory is
/// overwritten.
void begin_fade(const Pipeline& pipeline, PipelineState& state, int layer, int frame);

/// Of one frame.
struct Fades {
  std::map<int, FadingOut> out;  ///< by layer id: what is shown beside the layer's own sprite
  std::set<int> ended;           ///< layers whose own sprite is alone again
};

/// Carries all fades on to the frame of the report: completes the decisions of their layers and ends what is over.
Fades carry_fades(const Pipeline& pipeline, PipelineState& state, FrameReport& report);

}  // namespace talisman::sequences
