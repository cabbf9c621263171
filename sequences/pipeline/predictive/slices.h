// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which slice is a frame in, and what is planned for it? [F96 3.1, 3.2.1]
///
/// Where all motion is known, slices are of N frames from frame 0 on, and a frame's slice follows from its number. Where the
/// frames ahead are expected (Prediction::Linear) or slices adapt, it follows from all slices before it:
///
///   surprise   a frame in which a part is not where its slice expects it: displayed, as of the first frame of its run, it would be
///              more than δ off the scene as it has come (or its light, its picture or a blend differs). What is known to
///              jump (layers/jumps.h: a swarm that wraps around) is one by construction: no extrapolation can be right.
///              The plan is dropped: a new slice begins with that frame, in which all is drawn. So nothing is displayed more
///              than δ off, whatever was expected; a wrong expectation costs drawings, not error.
///              (A jump with which a slice begins anyway drops nothing, and counts.)
///   adaptive   N becomes N / k at a surprise, at least 1, and k N after two slices without one, at most as long as asked for
///
/// With motion that is known and slices that do not adapt nothing is a surprise: the words know of a jump.
///
/// A slice is the same whenever it is asked for: frames come in any order.

#include <optional>
#include <vector>

#include "regulator/plan_intervals.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/pipeline/predictive/part_motion.h"

namespace talisman::sequences {

/// Slices without a surprise after which one is longer.
inline constexpr int kQuietSlices = 2;

struct Slice {
  int first = 0;
  int frames = 1;     ///< planned for
  int end = 1;        ///< it was dropped before this frame; first + frames: it was not
  int surprised = 0;  ///< parts by which the one before was dropped; jumps count, too
  int quiet = 0;      ///< slices without a surprise right before it, since it was as long
  bool operator==(const Slice&) const = default;
};

/// A slice, and what is planned for it.
struct PlannedSlice {
  Slice slice;
  MotionSlice motion;
  regulator::PlanIntervals intervals;
};

/// The frames of a run, slice by slice.
class Slices {
 public:
  explicit Slices(const Pipeline& pipeline);

  const FollowedParts& followed() const { return followed_; }

  /// That of `frame`, planned anew unless it is the one at hand. The reference holds until the next call.
  const PlannedSlice& of(const Pipeline& pipeline, int frame);

  /// The scene of an instant as it was expected at the beginning of the slice.
  static layers::SceneFrame expected(const Pipeline& pipeline, const Slice& slice, int instant);

 private:
  PlannedSlice planned(const Pipeline& pipeline, Slice slice) const;
  void find_end(const Pipeline& pipeline, PlannedSlice& planned) const;
  Slice after(const Pipeline& pipeline, const PlannedSlice& planned) const;
  const PlannedSlice& keep(PlannedSlice planned);

  regulator::RegulatorOptions options_;
  layers::ivec2 display_px_;
  FollowedParts followed_;
  std::vector<std::int64_t> weights_;  ///< triangles, by index of the parts
  std::vector<double> jumps_;          ///< times; empty unless slices adapt
  bool by_number_ = true;              ///< does a frame's slice follow from its number?
  std::vector<Slice> known_;           ///< from frame 0 on, unless by_number_; the last one is not yet closed
  std::optional<PlannedSlice> at_hand_;
};

}  // namespace talisman::sequences
