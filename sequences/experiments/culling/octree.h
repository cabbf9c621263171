// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An octree over boxes, tight or loose [AA 9.1].
///
/// Cells are halved along all axes. Tight: a box lies in the smallest cell that encloses it, so that a small one
/// on a dividing plane climbs far up. Loose, with k > 1: a cell of side l holds what its neighbourhood of side
/// k l encloses; a box lies in the cell of its middle, at the level where its half extents are at most
/// (k - 1) l / 2, so that node and level follow from size and place, and moving is O(levels). The price is that
/// the boxes of cells overlap.

#include <array>
#include <cstdint>

#include "layers/box_index.h"

namespace talisman::sequences {

class Octree final : public layers::BoxIndex {
 public:
  /// `looseness` k: 1 (tight) … 2.
  explicit Octree(double looseness) : looseness_(looseness) {}

  void build(std::span<const layers::Box3> boxes) override;
  void update(std::span<const layers::Box3> boxes, std::span<const int> moved) override;
  void query(std::span<const layers::Plane> region, std::vector<int>& found,
             layers::QueryCounters& counters) override;

  static constexpr int kMostLevels = 12;

 private:
  struct Cell {
    std::array<std::int32_t, 8> child{-1, -1, -1, -1, -1, -1, -1, -1};
    std::int32_t parent = -1;
    int level = 0, below = 0;  ///< boxes in it and below it
    layers::dvec3 centre{0, 0, 0};
    layers::Box3 bounds;  ///< looseness · side
    std::vector<int> entries;
    std::vector<layers::BoxLanes> lanes;  ///< of the entries, four by four
  };
  struct Place {
    std::int32_t cell = -1, slot = 0;
  };
  std::int32_t cell_for(const layers::Box3& box);
  bool fits(const layers::Box3& box, const layers::dvec3& centre, double side) const;
  std::int32_t child_of(std::int32_t cell, int octant);
  void insert(int entry, const layers::Box3& box);
  void remove(int entry);
  void take_all(const Cell& cell, std::vector<int>& found) const;
  void visit(const Cell& cell, const layers::RegionTest& test, layers::PlaneMask mask,
             std::vector<int>& found, layers::QueryCounters& counters) const;
  void test_entries(const Cell& cell, const layers::RegionTest& test, layers::PlaneMask mask,
                    std::vector<int>& found, layers::QueryCounters& counters) const;

  double looseness_, side_m_ = 0, reach_m_ = 0;
  std::vector<Cell> cells_;
  std::vector<Place> place_;
};

}  // namespace talisman::sequences
