// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The chunks of a sprite in which there is something to draw.

#include <span>
#include <vector>

#include "chunker/bin.h"
#include "chunker/draw_list.h"

namespace talisman::chunker {

struct ChunkWork {
  Bins bins;
  std::vector<int> places;  ///< row · columns + column, ascending
};

/// Fills `list` and bins its triangles.
ChunkWork set_up_chunks(const PreparedScene& prepared, const layers::SceneFrame& frame,
                        std::span<const int> parts, layers::ivec2 display_px,
                        const layers::SpritePlacement& placement, const RenderOptions& options,
                        const ShadeInputs& inputs, DrawList& list);

}  // namespace talisman::chunker
