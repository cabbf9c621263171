// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which pieces move as one over a whole sequence? Groups of constant relative transforms (layers/rigid_groups.h), as
/// `layers: {auto: motion}` makes layers of them and `talisman motion` proposes.

#include <vector>

#include "sequences/content/factoring/pieces.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Groups of the free pieces, each ascending, in the order of their first pieces. Every frame of `settings` is looked at. A piece
/// whose own parts move against each other, or deform, is alone. Cost: O(frames · nodes), and see RigidGroups::follow.
std::vector<std::vector<int>> groups_that_move_as_one(const layers::Scene& scene, const Pieces& pieces,
                                                      const Settings& settings);

}  // namespace talisman::sequences
