// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect --order`: the visibility order of a whole sequence, without its pictures. Which frames
/// have the same order, which layers were merged, from when to when and why, and what the sort cost.

#include <string>
#include <utility>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Frames, both inclusive, with the same layers in the same order.
struct OrderRun {
  int first = 0, last = 0;
  std::vector<std::string> back_to_front;
};

/// One aggregate over the time for which it existed without a gap. The same layers may be merged several
/// times.
struct MergedRun {
  int first = 0, last = 0;
  std::string name;
  std::vector<std::string> members;
  std::string why;  ///< in the first frame
};

struct OrderOverTime {
  std::vector<OrderRun> runs;     ///< in the order of time; they cover every frame
  std::vector<MergedRun> merged;  ///< by first frame
  std::vector<MergedRun>
      resolved;  ///< the same of cycles that kept their sprites: no name, `why` the expression
  int frames = 0, frames_sorted = 0, frames_with_cycles = 0;
  layers::VisibilityCounters sum;  ///< over all frames
  std::int64_t merged_parts = 0;   ///< over all frames
  double sort_ms = 0, slowest_sort_ms = 0;
};

OrderOverTime order_over_time(const Sequence& sequence, const Settings& settings);

std::string order_text(const Sequence& sequence, const OrderOverTime& order);
std::string order_json(const Sequence& sequence, const OrderOverTime& order);  ///< schema talisman.order/1

}  // namespace talisman::sequences
