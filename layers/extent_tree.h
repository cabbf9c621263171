// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which bodies can be met in the same direction of view? A kd-tree over angular extents [LS97 2.2].
///
/// Seen from the eye e a body covers a set of unit directions u = (p - e) / |p - e|. Its angular extents are
/// the intervals of u·x, u·y, u·z: a box in the space of directions, which needs no chart of the sphere and
/// no care behind the eye. Boxes that do not overlap prove that neither body can occlude the other.
///
/// Why directions and not positions: possible occluders of a body lie anywhere between it and the eye, so
/// that a tree over positions would have to visit the whole cone from the eye; in the space of directions the
/// same question is the overlap of two small boxes. Positions decide afterwards which of two is nearer.
///
/// The tree halves the boxes at the median of their middles along the widest coordinate, and each node keeps
/// the extents of what is below it. Boxes may change; `refit` then restores the extents, and tells by how
/// much the tree has become worse than when it was built.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::layers {

/// Intervals of the coordinates of unit directions. Floats: a box is rounded outwards, and half the memory is
/// read by every query.
struct DirectionBox {
  std::array<float, 3> lo{HUGE_VALF, HUGE_VALF, HUGE_VALF};
  std::array<float, 3> hi{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};  ///< lo > hi: nothing
  bool empty() const { return lo[0] > hi[0]; }
};

// Without branches: both are asked of every node that a query visits.
inline bool overlap(const DirectionBox& a, const DirectionBox& b) {
  int meets = 1;
  for (int k = 0; k < 3; ++k) meets &= int{a.lo[k] <= b.hi[k]} & int{b.lo[k] <= a.hi[k]};
  return meets != 0;
}

inline bool contains(const DirectionBox& outer, const DirectionBox& inner) {
  int inside = 1;
  for (int k = 0; k < 3; ++k) inside &= int{outer.lo[k] <= inner.lo[k]} & int{inner.hi[k] <= outer.hi[k]};
  return inside != 0;
}

/// The directions from `eye` to the box lo … hi: exact intervals (each coordinate of u grows with its own
/// difference, and falls with the size of the others), rounded outwards. A box around the eye is met in all
/// directions.
DirectionBox directions_to(const dvec3& eye, const dvec3& lo, const dvec3& hi);

class ExtentTree {
 public:
  /// `boxes` are indexed by entry; empty ones are left out. Cost: O(n log n).
  void build(std::span<const DirectionBox> boxes);

  /// Takes changed boxes of the same entries. Returns the sum of all nodes' extents relative to that when the
  /// tree was built; above 1.3 or so building anew pays. Cost: O(n).
  double refit(std::span<const DirectionBox> boxes);

  /// Appends the entries whose boxes overlap `box`. Cost: O(log n + found) for small boxes.
  void query(const DirectionBox& box, std::span<const DirectionBox> boxes, std::vector<int>& found) const;

 private:
  struct Node {
    DirectionBox box;
    std::int32_t next = 0;              ///< the node after this subtree; nodes lie in the order of the walk
    std::int32_t first = 0, count = 0;  ///< of a leaf, in entries_
  };
  void split(std::span<const DirectionBox> boxes, int first, int count);
  double widths() const;

  std::vector<Node> nodes_;
  std::vector<int> entries_;
  double built_widths_ = 0;
};

}  // namespace talisman::layers
