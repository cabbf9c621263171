// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The chunk renderer (chunker/render.h) into a buffer with depth, as large as the display.

#include "chunker/plan_buffer.h"
#include "chunker/render.h"

namespace talisman::chunker {

struct DepthRenderResult {
  PlanBuffer buffer;
  RenderCounters counters;
};

/// As `render` with a placement of texel on pixel of the display. `numbers`: of each part the number that its texels get,
/// ascending. What can be seen through has no one depth: parts are opaque, or the nearest of what they mix counts.
DepthRenderResult render_with_depth(const PreparedScene& prepared, const layers::SceneFrame& frame,
                                    std::span<const int> parts, std::span<const std::uint32_t> numbers,
                                    layers::ivec2 display_px, const RenderOptions& options = {},
                                    const ShadeInputs& inputs = {});

}  // namespace talisman::chunker
