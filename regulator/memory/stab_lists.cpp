// SPDX-License-Identifier: Apache-2.0
#include "regulator/memory/stab_lists.h"

#include <algorithm>
#include <map>

namespace talisman::regulator {

using layers::Box3;

StabLists::StabLists(std::shared_ptr<const layers::CellSet> set, std::span<const Box3> boxes)
    : set_(std::move(set)),
      portals_of_(set_->portals_of()),
      boxes_(boxes.begin(), boxes.end()),
      things_in_(set_->cells.size()),
      seen_from_(set_->cells.size()),
      reach_m_(layers::reach_of(boxes)) {
  for (const layers::Cell& cell : set_->cells) cell_boxes_.push_back(layers::box_of(cell.lo, cell.hi));
  for (std::size_t thing = 0; thing < boxes.size(); ++thing) {
    bool is_in_one = false;
    for (std::size_t cell = 0; cell < cell_boxes_.size(); ++cell)
      if (meet(boxes[thing], cell_boxes_[cell])) {
        things_in_[cell].push_back(static_cast<int>(thing));
        is_in_one = true;
      }
    if (!is_in_one && !boxes[thing].empty()) outside_.push_back(static_cast<int>(thing));
  }
}

const std::vector<StabEntry>& StabLists::seen_from(int cell) {
  if (seen_from_[cell]) return *seen_from_[cell];
  std::map<int, std::vector<layers::RegionTest>> regions;
  for (const layers::CellSight& sight : layers::sights_from_cell(*set_, portals_of_, cell))
    regions[sight.cell].emplace_back(sight.region, reach_m_);
  std::vector<StabEntry> entries;
  for (const auto& [seen, tests] : regions) {
    StabEntry entry{seen, {}};
    for (const int thing : things_in_[seen]) {
      const Box3 inside = intersection(boxes_[thing], cell_boxes_[seen]);
      if (std::any_of(tests.begin(), tests.end(), [&](const auto& test) { return !test.misses(inside); }))
        entry.things.push_back(thing);
    }
    entries.push_back(std::move(entry));
  }
  return seen_from_[cell].emplace(std::move(entries));
}

}  // namespace talisman::regulator
