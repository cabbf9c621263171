// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One frame of the pipeline: the only place where the decision side (layers, warp, fiducials, regulator) and
/// the pixel side (chunker) meet.
///
///   scene.at(t) → capture → order → correspond → fit → assess → regulate → [render →] [composite →] report
///
/// Without `prepared` a frame is planned and nothing is drawn; the decisions are the same. A frame may
/// also be planned while its pictures are left for later: a sprite that was planned but not drawn is drawn,
/// as of the instant for which it was planned, when a frame that must be shown needs it. From this follow
/// --frames and --resume: any frame of a sequence comes out with the same bytes, however it is reached.

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Plans frame `frame` and, if `prepared` is given, draws it. Frames come in order from 0; a frame may be
/// repeated, and (with policies that do not look ahead) frames may run backwards. The same `state` may be
/// carried on under a pipeline of other settings: sprites and what is known of them stay, what was planned
/// ahead is planned anew.
FrameReport step(const Pipeline& pipeline, PipelineState& state, int frame,
                 const chunker::PreparedScene* prepared);

/// The frame as the policies `direct` and `reference` show it, without touching any state: the truths of
/// --quality. The reference of one frame sorts it by itself: what a run still holds merged after a cycle, it
/// shows apart, which differs only where a pixel is covered in part. Of a run that knows old poses only, `direct` is
/// the truth all the same: what the camera sees. `reference` is as late as the run.
chunker::Frame draw_direct(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared);
chunker::Frame draw_reference(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared);

}  // namespace talisman::sequences
