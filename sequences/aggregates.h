// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The visibility order of a run, frame after frame, and the layers that it makes on the way [LS97 2.2].
///
/// Only layers with something on the display take part. Where layers occlude each other in a cycle they are
/// merged: an aggregate (layers/aggregate.h) gets an id behind those of the author's layers and is from then
/// on a layer like others, with its own memory, assessment, decision and sprite. The same set of layers has
/// the same aggregate for the whole run. While it lasts its members are dropped; what is remembered of them
/// stays, so that after the split their old sprites are shown again as long as the fiducials allow it. The
/// sprite of an aggregate is kept as well, and dropped when the aggregate has been gone for
/// kKeepAggregate_frames.
///
/// With the extended compositor most cycles are not merged (sequences/resolved_cycles.h).
///
/// Policies that look ahead (Lookahead, Oracle) judge every layer, aggregates included, as if the grouping of
/// the frame that is planned lasted: they do not foresee merging and splitting.

#include <memory>
#include <vector>

#include "sequences/frame_order.h"

namespace talisman::sequences {

struct Pipeline;
struct PipelineState;
struct FrameReport;

/// The pipeline with all aggregates made so far behind the author's layers. Never changed, so that copies of
/// a state can share it.
struct GrownPipeline;

/// What is remembered of the order from frame to frame. A value.
struct OrderMemory {
  layers::VisibilitySorter sorter;
  std::shared_ptr<const GrownPipeline> grown;  ///< null: no aggregate was made yet
  std::vector<int> merged_into;                ///< of the last frame, by layer id
  std::vector<int> last_seen;                  ///< by aggregate: the last frame in which it existed
  int frame = -1;                              ///< the last frame that was ordered
  int generation = 0;                          ///< grows with every change of the aggregates that exist
};

/// The frames after which the sprite and the memory of an aggregate that no longer exists are given up. More
/// keeps sprites of cycles that return, and their memory.
inline constexpr int kKeepAggregate_frames = 48;

/// `authored` with the aggregates made so far; `authored` itself as long as there are none.
const Pipeline& with_aggregates(const Pipeline& authored, const PipelineState& state);
const Pipeline& with_aggregates(const Pipeline& authored, const GrownPipeline* grown);

/// Does the aggregate (or any other layer) `layer` exist in the frame that was ordered last?
bool exists_now(const Pipeline& pipeline, const PipelineState& state, int layer);

/// The order of frame `frame`; merges and splits. Frames must come in order. Cost: layers/visibility.h.
FrameOrder order_layers(const Pipeline& authored, PipelineState& state, int frame);

/// Puts what was merged and split into the reasons of the plan.
void explain_order(const Pipeline& pipeline, FrameReport& report);

}  // namespace talisman::sequences
