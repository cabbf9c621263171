// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where do the intervals of a plan lie: at fixed places, or where the words of a slice leave most at rest? Pure: from
/// motion words alone. [F96 5.3] leaves the second open ("intervals based on the polygon-frames factored out").
///
/// As in regulator/plan_tree.h level 0 is the slice and the last level its frames; in between each level cuts the intervals
/// of the one above. With W things in all, by weight, and R(a, b) those at rest in frames a … b - 1 (their bit a does not
/// matter), an interval q within p is drawn into by what rests in it and not in all of p:
///
///   drawings = R(0, N) + Σ over all q below (R(q) - R(p)),      R of a single frame = W
///
/// The least sum is found level by level, from the frames up: the best cut of each interval is the shortest path over its
/// frames. Fixed intervals are one of the cuts, so that data-driven ones never draw more; the number of buffers is the
/// same. They are those of one slice: frames of two slices have nothing in common anyway.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "regulator/plan_tree.h"

namespace talisman::regulator {

enum class Intervals {
  Fixed,  ///< of N / k^l frames
  Data,   ///< chosen for each slice
};
inline constexpr std::array kAllIntervals = {Intervals::Fixed, Intervals::Data};
std::string_view name(Intervals intervals);  ///< "fixed", "data"

/// The longest slice whose intervals are chosen: the search takes N⁴ / 24 steps for each level.
inline constexpr int kLongestCut_frames = 128;

/// The intervals of each level of one slice.
class PlanIntervals {
 public:
  /// Fixed ones.
  explicit PlanIntervals(const PlanShape& shape);

  int frames() const { return frames_; }
  int levels() const { return static_cast<int>(ends_.size()); }
  /// The interval of `level` that holds `frame`, 0 … frames() - 1: first … end - 1.
  int first(int level, int frame) const { return firsts_[level][frame]; }
  int end(int level, int frame) const { return ends_[level][frame]; }

  /// The drawing that shows a thing in `frame`: on the lowest level in whose interval it rests.
  PlannedDraw draw_shown(const MotionWord& word, int frame) const;
  /// All drawings of a slice, in order.
  std::vector<PlannedDraw> planned_draws(const MotionWord& word) const;

  bool operator==(const PlanIntervals&) const = default;

 private:
  friend PlanIntervals fitted_intervals(const PlanShape&, std::span<const MotionWord>,
                                        std::span<const std::int64_t>);
  int frames_ = 1;
  std::vector<std::vector<int>> firsts_, ends_;  ///< by level and frame
};

/// Those with the fewest drawings, by weight ≥ 0, among all with as many levels as `shape` has. One weight for each word, or
/// none: all count alike. shape.frames ≤ kLongestCut_frames. Of equal ones the earliest cuts. Cost: O(words · N + levels · N⁴ / 24).
PlanIntervals fitted_intervals(const PlanShape& shape, std::span<const MotionWord> words,
                               std::span<const std::int64_t> weights = {});

}  // namespace talisman::regulator
