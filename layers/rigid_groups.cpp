// SPDX-License-Identifier: Apache-2.0
#include "layers/rigid_groups.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

namespace talisman::layers {

namespace {

constexpr double kTolerance = 1e-9;

bool all_finite(const dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

bool move_alike(const dmat4& a, const dmat4& b) {
  for (int column = 3; column >= 0; --column)  // most differ by where they are
    for (int row = 0; row < 4; ++row) {
      const double size = std::max({1.0, std::abs(a[column][row]), std::abs(b[column][row])});
      if (!(std::abs(a[column][row] - b[column][row]) <= kTolerance * size)) return false;
    }
  return true;
}

}  // namespace

RigidGroups::RigidGroups(const SceneFrame& first, std::span<const int> parts)
    : first_from_world_(first.scene->parts.size(), dmat4(1.0)) {
  std::vector<int> rigid;
  std::vector<std::vector<int>> others;
  for (const int part : parts) {
    const Part& what = first.scene->parts[part];
    first_from_world_[part] = inverse(first.world_from_node[what.node]);
    if (deforms(*first.scene, what) || !all_finite(first_from_world_[part]))
      others.push_back({part});
    else
      rigid.push_back(part);
  }
  if (!rigid.empty()) groups_.push_back(std::move(rigid));
  groups_.insert(groups_.end(), others.begin(), others.end());
}

void RigidGroups::follow(const SceneFrame& now) {
  std::vector<std::vector<int>> pieces;
  for (std::vector<int>& group : groups_) {
    if (group.size() == 1) {
      pieces.push_back(std::move(group));
      continue;
    }
    const std::size_t first = pieces.size();
    std::vector<dmat4> motions;  // of the pieces
    for (const int part : group) {
      const dmat4 motion = now.world_from_node[now.scene->parts[part].node] * first_from_world_[part];
      const auto alike = std::find_if(motions.begin(), motions.end(),
                                      [&](const dmat4& other) { return move_alike(motion, other); });
      if (alike == motions.end()) {
        motions.push_back(motion);
        pieces.push_back({part});
      } else {
        pieces[first + static_cast<std::size_t>(alike - motions.begin())].push_back(part);
      }
    }
  }
  groups_ = std::move(pieces);
}

}  // namespace talisman::layers
