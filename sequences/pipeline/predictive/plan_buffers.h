// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Policy Predictive: a frame out of a few full-screen buffers with depth [F96 3.1].
///
/// Frames come in slices (slices.h). At the beginning of a slice the motion of each part over it is known or expected
/// (part_motion.h), and from that follows what is drawn into which buffer in which frame (regulator/plan_intervals.h). A part is drawn as of the
/// first frame of its run, so that nothing is displayed more than δ off. With δ = 0 and one sample for each texel a frame
/// is the picture of policy Direct, byte for byte.
///
/// What a frame shows follows from the words of its slice alone: one node of the tree for each level, with the parts that
/// belong there. So frames may be asked for in any order, repeated, or left undrawn; what a frame needs and no buffer holds is
/// drawn then.
///
///   EachFrame   a buffer holds the parts of its own level; all are joined for each frame
///   Copy        it holds those of the levels above, too: a node begins as a copy of the picture that it is laid over
///   InPlace     the same, but a node that ends with the buffer that it is laid over goes on in that buffer
///
/// A node without parts has no picture: what is laid over it lies over what is below it.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "chunker/plan_buffer.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/pipeline/predictive/slices.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/shadow_map_planning.h"

namespace talisman::sequences {

/// Why the scene cannot be drawn into buffers that are joined by depth, in words: something can be seen through, mirrors,
/// or is faded. Empty: it can.
std::string unpredictable(const layers::Scene& scene, const layers::LayerSet& set);

/// A part that a frame shows, by index of FollowedParts::parts.
struct ShownPart {
  int index = -1;
  int level = 0;
  int drawn = 0;    ///< frame in which it is drawn
  int instant = 0;  ///< as of which it is
};

/// A node of the tree: the frames first … end - 1 of the sequence.
struct PlanNode {
  int level = 0, first = 0, end = 1;
  bool operator==(const PlanNode&) const = default;
};

/// What survives a frame.
class PredictiveMemory {
 public:
  explicit PredictiveMemory(const Pipeline& pipeline);
  PredictiveMemory(const PredictiveMemory&) = delete;
  PredictiveMemory& operator=(const PredictiveMemory&) = delete;

  /// Is it of this pipeline?
  bool is_of(const Pipeline& pipeline) const;
  const FollowedParts& followed() const { return slices_.followed(); }

  /// The slice that holds `frame`, which is then the one at hand; planned anew if that is another.
  const PlannedSlice& slice_of(const Pipeline& pipeline, int frame);

  /// What is seen in `frame` of the slice at hand, in the order of one pass.
  std::vector<ShownPart> parts_shown(int frame) const;

  /// Brings the buffers up to `frame` and joins them. Pictures that were due in an earlier frame are counted in `late`.
  chunker::PlanBuffer* join(const Drawing& drawing, int frame, chunker::RenderCounters& render,
                            chunker::RenderCounters& late, int& late_nodes, chunker::JoinCounters& joins);

  /// Milliseconds that `join` has spent with buffers that were drawn, all calls together.
  double joining_ms() const { return joining_ms_; }

  /// Joins of `frame` as the plan has them, pictures or not.
  void count_joins(int frame, const std::vector<ShownPart>& shown, PredictiveReport& report) const;

  std::int64_t bytes() const;

 private:
  struct Held {
    chunker::PlanBuffer buffer;
    std::vector<PlanNode> content;  ///< whose parts it holds
  };
  PlanNode node_at(int level, int frame) const;
  chunker::PlanBuffer draw_node(const Drawing& drawing, const std::vector<ShownPart>& shown, int level,
                                chunker::RenderCounters& counters, chunker::JoinCounters& joins) const;
  bool goes_on(const Held* under, const PlanNode& node) const;
  template <typename Draw>
  chunker::PlanBuffer* join_each_frame(const std::vector<PlanNode>& nodes, const Draw& draw,
                                       chunker::JoinCounters& joins);
  template <typename Draw>
  chunker::PlanBuffer* join_on_the_fly(const std::vector<PlanNode>& nodes, const Draw& draw,
                                       chunker::JoinCounters& joins);

  LayerTable authored_;
  regulator::RegulatorOptions options_;
  layers::ivec2 display_px_;
  double fps_;
  const layers::Scene* scene_;
  Slices slices_;
  const PlannedSlice* at_hand_ = nullptr;  ///< of slices_
  double joining_ms_ = 0;
  std::vector<Held> buffers_;    ///< by level
  chunker::PlanBuffer picture_;  ///< EachFrame: where they are joined
};

/// Decides what of each layer is drawn in the frame of `report`: replaces the decisions of its layers, and counts.
/// The shadow maps that are looked up for it are noted, too.
void plan_predicted(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps,
                    FrameReport& report);

/// The frame. `drawing` is of the author's layers, and of the scene at that frame.
chunker::CompositeResult draw_predicted(const Drawing& drawing, PipelineState& state, FrameReport& report);

}  // namespace talisman::sequences
