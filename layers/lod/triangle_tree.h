// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which point of a surface is nearest to a given one?
///
/// A binary tree of boxes over triangles, halved at the median of the middles along the widest axis; a query goes to the
/// nearer child first and leaves out what is farther than the best so far.

#include <cstdint>
#include <span>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::layers {

class TriangleTree {
 public:
  /// Three indices per triangle; a triangle without area is its edges. Cost: O(n log n).
  TriangleTree(std::vector<dvec3> positions, std::span<const std::uint32_t> indices);

  /// To the nearest point of any triangle; infinite where there is none. Cost: O(log n) as a rule.
  double distance(const dvec3& point) const;

  /// Of the triangles at most `within_m` away: the largest n · facing, n their unit normals; -2 where none with an area is.
  double best_facing(const dvec3& point, double within_m, const dvec3& facing) const;

 private:
  struct Triangle {
    dvec3 a, b, c;
  };
  struct Node {
    dvec3 lo, hi;
    int first = 0, count = 0;  ///< leaf: of triangles_; inner: count 0, children at left and right
    int left = -1, right = -1;
  };
  int build(int first, int count);
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace talisman::layers
