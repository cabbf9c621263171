// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which neighbours in the order of one frame share a sprite? The sorter's line of layers and cycles, with the sets
/// that the regulator wants to share a sprite (sequences/pipeline/regrouping/regroup.h) drawn together.
///
/// The members of a set share as long as nothing stands between them in the order of the frame; where something does,
/// each stretch shares by itself. Members that are out of view stay in the set: they cost nothing, and the sprite of the
/// rest stays the same. What is merged since it has no order is never split or joined here.

#include <string>
#include <vector>

#include "layers/visibility.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// A sprite of the frame, before it has an id.
struct OrderEntry {
  std::vector<int> layers;                         ///< ascending
  const layers::MergedComponent* cycle = nullptr;  ///< of which it is all; null: none
  const std::string* why_shared = nullptr;         ///< null: it is not
};

/// Back to front. The pointers point into `visibility` and `state`. Notes the line in `state.regroup`, where the regulator
/// regroups.
std::vector<OrderEntry> order_entries(const Pipeline& pipeline, const layers::VisibilityOrder& visibility,
                                      PipelineState& state);

/// May the layer share a sprite at all? It is a surface with all its shading in it, which neither fades nor has whole extents
/// nor a blur. An explicit pair does not keep two apart: as in a cycle, the z-buffer decides then.
bool may_share(const Pipeline& pipeline, int layer);

/// … and may these two share one: are their group and the wishes of their author the same?
bool may_share(const Pipeline& pipeline, int a, int b);

}  // namespace talisman::sequences
