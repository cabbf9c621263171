// SPDX-License-Identifier: Apache-2.0
#pragma once

/// As of which instant is a layer drawn that must be drawn now? Policies Lookahead and Oracle.
///
/// The paper draws a sprite as it looks now, so that its error only grows. With the motion known ahead
/// [F96] it can be drawn as it will look in the middle of the frames that it is to serve, and be warped back
/// first and forward later. Whether a sprite of instant r serves frame f is judged by what `step` will judge
/// when f comes: the same states, placement, fit, fiducials and thresholds. So the run that is promised is
/// the run that comes true. The instants are confined to `lookahead_frames` (or are all of the sequence);
/// how long a sprite will last is judged kFarthestLook_frames beyond them, so that a long sequence takes no more memory than
/// a short one: of instants that all serve so long the first is taken. Oracle judges to the sequence's end, and keeps what it looked at.
///
/// With Prediction::Linear the frames ahead are those of layers/predict.h, made from the frame at hand and
/// the one before, and a sprite's life is judged 2 N frames ahead. The sprite is drawn as of the *expected*
/// instant, so what it shows may never come true. Therefore it is judged, here for the frame at hand and by
/// `step` for every later one, by the state that was really drawn against the state that really came: a frame
/// that it does not serve is drawn as of now. So the bound of the displayed error holds whatever was
/// expected; a wrong expectation costs renders, not error.

/// Most pairs of an instant and a frame need no fiducial to be judged, and none of these is judged otherwise for it:
///
///   serves       nothing that the layer's picture depends on moves from the one to the other (layers/rest.h): found
///                from the tracks, without either state
///   serves not   its characteristic points, or all that are matched, are farther from any affine map of the old ones
///                than the threshold allows (fiducials/place_floor.h); where the layer's warps are of the perspective
///                family nothing is said.
///                Or a place of a shadow, highlight or reflection has run farther over it than that, which no warp of the
///                surface undoes (fiducials/shade_drift.h)
///
/// So what rests costs nothing, as an interval that is dismissed in regulator/certified_words.h, and of what turns only the
/// instants near enough are fitted. Colours, sampling and edges have no such bound: they are evaluated.

#include "regulator/schedule.h"
#include "sequences/pipeline/lookahead_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

inline constexpr int kFarthestLook_frames = 250;  ///< 10 s at 25 frames a second

/// The instant that serves the longest run from `frame` on, and that run. The layer is in view at `frame`.
/// Cost: capture, placement and assessment (some µs) of each instant that may be chosen and of each frame of
/// the runs that win; memory: the states of every frame looked at, some kB per layer.
/// What was asked is added to `counts`.
regulator::FrameRun choose_draw_instant(const Pipeline& pipeline, PipelineState& state, int layer, int frame,
                                        LookaheadReport* counts = nullptr);

/// Does the run, chosen in `frame`, end where nobody looked farther, before the sequence does?
bool looks_no_farther(const Pipeline& pipeline, int frame, const regulator::FrameRun& run);

}  // namespace talisman::sequences
