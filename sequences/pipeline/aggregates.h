// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The visibility order of a run, frame after frame, and the layers that it makes on the way [LS97 2.2].
///
/// Only layers with something on the display take part. Where layers occlude each other in a cycle they are
/// merged: an aggregate (layers/aggregate.h) gets an id behind those of the author's layers and is from then
/// on a layer like others, with its own memory, assessment, decision and sprite. While it lasts its members
/// are dropped; what is remembered of them stays, so that after the split their old sprites are shown again
/// as long as the fiducials allow it. The sprite of an aggregate is kept as well, and dropped when the
/// aggregate has been gone for kKeepAggregate_frames; then its id is free for another one. So the tables that
/// grow with the ids, and with them the time of a frame, stay bounded however long a run is. The same set of
/// layers has the same name and the same serial number for the whole run: what the results list, they list by
/// these.
///
/// With the extended compositor most cycles are not merged (sequences/pipeline/resolved_cycles.h).
///
/// Policies that look ahead (Lookahead, Oracle) judge every layer, aggregates included, as if the grouping of
/// the frame that is planned lasted: they do not foresee merging and splitting.

#include <vector>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The frames after which the sprite and the memory of an aggregate that no longer exists are given up. More
/// keeps sprites of cycles that return, and their memory.
inline constexpr int kKeepAggregate_frames = 48;

/// A state that was made for another pipeline takes over the layers of this one, which must be the same but
/// for their bounds; aggregates are made anew. Nothing to do for its own.
void adopt_layers(const Pipeline& pipeline, PipelineState& state);

/// Does the aggregate (or any other layer) `layer` exist in the frame that was ordered last?
bool exists_now(const PipelineState& state, int layer);

/// The order of frame `frame`; merges and splits, so that `state.layers` may grow. Frames must come in order.
/// Cost: layers/visibility.h.
FrameOrder order_layers(const Pipeline& pipeline, PipelineState& state, int frame);

/// The order of an earlier frame as it stands in a later one (policies Hold and Interpolate): nothing was sorted,
/// merged or split.
FrameOrder standing_order(const FrameOrder& of_beat);

/// The layers that have a line in decisions.jsonl for this frame, in their order: the author's by id, then
/// the aggregates that exist by serial number.
std::vector<int> layers_with_lines(const PipelineState& state, const FrameReport& report);

/// The row of a layer in tables that list every layer of a run: its id, aggregates by serial number.
int row_in_run(const PipelineState& state, int layer);

/// Puts what was merged and split into the reasons of the plan.
void explain_order(FrameReport& report);

}  // namespace talisman::sequences
