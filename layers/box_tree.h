// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A bounding-volume hierarchy over boxes that move [AA 9.1, 9.4].
///
/// Each node has four children, boxes or nodes; it is built by halving at the median of the middles along the
/// widest axis, twice. What is below a node lies side by side in one list, so that what is wholly inside of
/// the region is copied and not visited.
///
/// A query carries the mask of the planes that cut the node above. Plane coherency [AA 9.4]: a node tests first the
/// plane that threw out one of its children last time, which from frame to frame mostly is the one that does
/// so again. The answer does not depend on it.
///
/// Moving: the box of a child is put in its place and the boxes above it are fitted again, up to the first that
/// stays as it is. The tree becomes worse as things scatter: a query's cost grows with the sum of the areas of
/// the nodes, and when that has grown by kWorse since it was built, it is built anew.

#include <cstdint>
#include <span>
#include <vector>

#include "layers/box_index.h"

namespace talisman::layers {

class BoxTree final : public BoxIndex {
 public:
  /// `coherent`: with the plane-coherency cache; without it for comparison alone.
  explicit BoxTree(bool coherent = true) : coherent_(coherent) {}

  /// Cost: O(n log n).
  void build(std::span<const Box3> boxes) override;
  /// Cost: O(moved · log n), or that of `build`. A box may become empty, or cease to be.
  void update(std::span<const Box3> boxes, std::span<const int> moved) override;
  /// Cost: O(nodes that planes cut + found).
  void query(std::span<const Plane> region, std::vector<int>& found, QueryCounters& counters) override;

  /// Sum of the nodes' areas relative to that when the tree was built.
  double worsening() const;
  int times_built() const { return times_built_; }
  static constexpr double kWorse = 1.5;

 private:
  static constexpr int kWidth = 4;
  struct Node {
    BoxLanes boxes;
    std::array<std::int32_t, kWidth> child{-1, -1, -1, -1};  ///< a node, or -1: a box
    std::array<std::int32_t, kWidth> first{}, count{};       ///< of what is below it, in entries_
    std::int32_t parent = -1, lane = 0;                      ///< its place in the node above
    std::uint8_t lanes = 0;                                  ///< bit k: child k is there and not empty
    std::uint8_t last_plane = 0;                             ///< that threw something out
  };
  struct Place {
    std::int32_t node = -1, lane = 0;
  };
  int split(std::span<const Box3> boxes, int first, int count, Place above);
  void put_child(std::span<const Box3> boxes, int node, int lane, int first, int count);
  void fit_above(int node);
  void note_reach(const Box3& box);
  unsigned cut_lanes(Node& node, const RegionTest& test, PlaneMask mask, std::array<PlaneMask, kWidth>& left,
                     QueryCounters& counters) const;
  void set_child_box(int node, int lane, const Box3& box);
  void take_whole(int first, int count, std::vector<int>& found) const;

  bool coherent_;
  std::vector<Node> nodes_;
  std::vector<int> entries_;
  std::vector<Place> place_;  ///< by box
  int empty_ = 0;             ///< boxes that are
  double area_ = 0, built_area_ = 0, reach_m_ = 0;
  int times_built_ = 0;
};

}  // namespace talisman::layers
