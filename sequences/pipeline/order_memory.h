// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is remembered of the visibility order from frame to frame: which layers are merged, and the
/// aggregates that a run has made. Data; how it is used is in sequences/pipeline/aggregates.h.

#include <map>
#include <string>
#include <vector>

#include "layers/visibility.h"

namespace talisman::sequences {

/// An aggregate of this run, existing or not: a line of its summary.
struct AggregateRecord {
  std::string name;  ///< that of no other layer
  int parts = 0, polygons = 0;
};

/// All aggregates of a run. Some hundred bytes each.
struct AggregateHistory {
  std::vector<AggregateRecord> records;       ///< by serial number, in the order in which they first existed
  std::map<std::vector<int>, int> serial_of;  ///< by the ids of the members
  std::map<std::string, int> names;           ///< of all layers; the suffix to try for the next of that name
};

/// One id behind those of the author's layers.
struct AggregateSlot {
  int serial = -1;     ///< of the aggregate that has it, or had it last
  int last_seen = -1;  ///< the last frame in which that existed
  bool is_free = false;
};

/// What is remembered of the order from frame to frame. A value.
struct OrderMemory {
  layers::VisibilitySorter sorter;
  std::vector<int> merged_into;      ///< of the last frame, by layer id
  std::vector<AggregateSlot> slots;  ///< by id, from the first behind the author's layers
  AggregateHistory history;
  int frame = -1;      ///< the last frame that was ordered
  int generation = 0;  ///< grows with every change of the aggregates that exist
};

}  // namespace talisman::sequences
