// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/motion_groups.h"

#include <algorithm>

#include "layers/rigid_groups.h"

namespace talisman::sequences {

std::vector<std::vector<int>> groups_that_move_as_one(const layers::Scene& scene, const Pieces& pieces,
                                                      const Settings& settings) {
  std::vector<int> parts;
  for (std::size_t i = 0; i < pieces.free; ++i)
    parts.insert(parts.end(), pieces.layers[i].parts.begin(), pieces.layers[i].parts.end());
  layers::RigidGroups rigid(scene.at(0), parts);
  for (int frame = 1; frame < settings.frames; ++frame) rigid.follow(scene.at(frame / settings.fps));
  std::vector<int> group_of(scene.parts.size(), -1);
  const std::vector<std::vector<int>>& found = rigid.groups();
  for (std::size_t g = 0; g < found.size(); ++g)
    for (const int part : found[g]) group_of[part] = static_cast<int>(g);

  std::vector<std::vector<int>> joined(found.size()), groups;
  for (std::size_t i = 0; i < pieces.free; ++i) {
    const std::vector<int>& own = pieces.layers[i].parts;
    const int group = group_of[own.front()];
    const bool is_one =
        std::all_of(own.begin(), own.end(), [&](int part) { return group_of[part] == group; });
    if (is_one)
      joined[group].push_back(static_cast<int>(i));
    else
      groups.push_back({static_cast<int>(i)});
  }
  for (std::vector<int>& group : joined)
    if (!group.empty()) groups.push_back(std::move(group));
  std::sort(groups.begin(), groups.end());
  return groups;
}

}  // namespace talisman::sequences
