// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Every box against the region, four at a time, in the order of memory: what any structure must beat. An
/// update costs what moves, a query O(n).

#include "layers/box_index.h"

namespace talisman::sequences {

class FlatScan final : public layers::BoxIndex {
 public:
  void build(std::span<const layers::Box3> boxes) override;
  void update(std::span<const layers::Box3> boxes, std::span<const int> moved) override;
  void query(std::span<const layers::Plane> region, std::vector<int>& found,
             layers::QueryCounters& counters) override;

 private:
  std::vector<layers::BoxLanes> lanes_;
  std::vector<unsigned char> there_;  ///< bit k: lane k of that block is not empty
  double reach_m_ = 0;
};

}  // namespace talisman::sequences
