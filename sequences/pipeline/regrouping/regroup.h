// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers should share a sprite in the next frame, going by what this one showed? [D95] with sprites
/// (regulator/regroup.h has the test).
///
/// Known of this frame are which sprites had to be drawn; how long one lasts is counted from that:
///
///   a layer with a sprite of its own    frames between its renders
///   one that shares a sprite            the same for the sprite that it would have: its own old one, or one that is
///                                       only thought of, judged by all fiducials as if it were shown
///   two neighbours in the order         frames for which one warp carries the points of both within the geometric
///                                       threshold, whether they share a sprite or not
///   a set that shares a sprite          frames between its renders; before it has any, the shortest of the above
///
/// Only neighbours in the order are merged, two sprites at a time, and a set is cut in two where the order has its cut:
/// what stands between two layers may have to hide one of them. The best change is made first, then the next that does
/// not touch it, until the ceiling of the frame is reached.
///
/// Cost: a fit for each pair of neighbours and an assessment for each layer that shares a sprite, in every frame, about
/// what planning costs without it; 1-2 kB a layer.

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Learns from the frame that was planned, and decides for the next one. Only where the regulator regroups.
void regroup(const Pipeline& pipeline, PipelineState& state, const FrameReport& report);

}  // namespace talisman::sequences
