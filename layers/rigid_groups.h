// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which parts move as one, whatever the tree of nodes says? [F96 3.1.1] leaves it open.
///
/// A part has moved since the first frame by D(f) = M(f) M(0)⁻¹, M being its world matrix. Parts are one group if their D
/// are the same, to 1e-9 of their size, at every frame that was looked at: then their relative transforms stay constant,
/// whether they hang on one node, on nodes that a rig moves alike, or stand still in the world. Parts that deform, and
/// those whose matrix cannot be inverted, are groups of their own.

#include <span>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

class RigidGroups {
 public:
  /// All that can be one group, at the first frame.
  RigidGroups(const SceneFrame& first, std::span<const int> parts);

  /// Splits the groups whose parts have moved against each other by now. Cost: O(parts), and for a group that falls to
  /// pieces O(its parts · pieces).
  void follow(const SceneFrame& now);

  /// Parts in the order in which they were given; groups by their first part.
  const std::vector<std::vector<int>>& groups() const { return groups_; }

 private:
  std::vector<std::vector<int>> groups_;
  std::vector<dmat4> first_from_world_;  ///< by part
};

}  // namespace talisman::layers
