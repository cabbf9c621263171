// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What can an eye somewhere in a cell see: which cells, and which things in them? The stab list of [Fu93 4.1.1], worked out
/// for a cell when it is first asked for (layers/cell_visibility.h).

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "layers/cell_visibility.h"
#include "layers/region.h"

namespace talisman::regulator {

/// Of a cell that is seen: the things whose boxes meet what is seen of it, ascending.
struct StabEntry {
  int cell = -1;
  std::vector<int> things;
};

class StabLists {
 public:
  /// `boxes`: of all things, which rest.
  StabLists(std::shared_ptr<const layers::CellSet> set, std::span<const layers::Box3> boxes);

  const layers::CellSet& set() const { return *set_; }
  const std::vector<std::vector<int>>& portals_of() const { return portals_of_; }
  const layers::Box3& box_of_cell(int cell) const { return cell_boxes_[cell]; }
  /// By cell, ascending. Cost when asked for the first time: that of layers::sights_from_cell, and O(sights · things in them).
  const std::vector<StabEntry>& seen_from(int cell);
  /// All that lie at least partly in the cell, ascending.
  const std::vector<int>& things_in(int cell) const { return things_in_[cell]; }
  /// Those in no cell, ascending: nothing is known to hide them.
  const std::vector<int>& outside() const { return outside_; }

 private:
  std::shared_ptr<const layers::CellSet> set_;
  std::vector<std::vector<int>> portals_of_;
  std::vector<layers::Box3> boxes_, cell_boxes_;
  std::vector<std::vector<int>> things_in_;
  std::vector<int> outside_;
  std::vector<std::optional<std::vector<StabEntry>>> seen_from_;
  double reach_m_ = 0;
};

}  // namespace talisman::regulator
