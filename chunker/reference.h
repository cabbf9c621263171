// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Slow and obvious versions of the chunk renderer and the compositor: no chunks, no bins, no SIMD, no
/// threads. They are the oracles of the fast paths and must stay simple enough to be believed by reading.

#include "chunker/composite.h"
#include "chunker/render.h"

namespace talisman::chunker::reference {

/// Per-pixel loop over all triangles; every sub-pixel sample keeps its own sorted list of surfaces (no
/// fragments, no merging). The fast path equals it byte for byte when its merge tolerances are 0, and within
/// one code value otherwise. Shared with it are functions of one vertex or one point (transform, snap, shade,
/// encode).
Sprite render(const PreparedScene& prepared, const layers::SceneFrame& frame, std::span<const int> parts,
              layers::ivec2 display_px, const layers::SpritePlacement& placement,
              const RenderOptions& options = {}, const ShadeInputs& inputs = {});

/// Per-pixel loop over all sprites with the same arithmetic as the fast path, without bands, runs or SIMD:
/// equal byte for byte.
Frame composite(std::span<const PlacedSprite> sprites, layers::ivec2 display_px, layers::vec3 background);

}  // namespace talisman::chunker::reference
