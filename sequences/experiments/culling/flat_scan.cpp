// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/culling/flat_scan.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace talisman::sequences {

void FlatScan::build(std::span<const layers::Box3> boxes) {
  lanes_.assign((boxes.size() + 3) / 4, {});
  there_.assign(lanes_.size(), 0);
  reach_m_ = 0;
  std::vector<int> all(boxes.size());
  std::iota(all.begin(), all.end(), 0);
  update(boxes, all);
}

void FlatScan::update(std::span<const layers::Box3> boxes, std::span<const int> moved) {
  for (const int i : moved) {
    const auto block = static_cast<std::size_t>(i / 4);
    const unsigned bit = 1u << (i % 4), others = there_[block] & ~bit;
    lanes_[block].put(i % 4, boxes[i]);
    there_[block] = static_cast<unsigned char>(boxes[i].empty() ? others : others | bit);
    reach_m_ = std::max(reach_m_, layers::reach_of({&boxes[i], 1}));
  }
}

void FlatScan::query(std::span<const layers::Plane> region, std::vector<int>& found,
                     layers::QueryCounters& counters) {
  const layers::RegionTest test(region, reach_m_);
  counters.nodes += static_cast<std::int64_t>(lanes_.size());
  for (std::size_t block = 0; block < lanes_.size(); ++block) {
    unsigned alive = there_[block];
    int plane = 0;
    for (; plane < test.planes() && alive != 0; ++plane) alive &= ~test.outside(plane, lanes_[block]);
    counters.tests += plane;
    for (; alive != 0; alive &= alive - 1)
      found.push_back(static_cast<int>(4 * block) + std::countr_zero(alive));
  }
}

}  // namespace talisman::sequences
