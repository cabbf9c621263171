// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How often is a texel of a sprite filled, because surfaces hide others? [LS97 footnote 11]
///
///   d = Σ area of the triangles that face the eye, on the sprite / Σ area of the sprites' rectangles, at least 1
///
/// over the first sprite of every layer so far. A budget of modelled time allows for t · rate / d texels of
/// rectangles. The plan must be the same whether pictures are drawn or not, so this is measured on the geometry and
/// not on what the renderer counts: it takes every surface for filled, also those that the z-buffer turns away
/// because something nearer was drawn before, so that the budget is rather kept than exceeded. Triangles across
/// the near plane are left out, and skins are taken in their rest pose. The drawn figure stands beside it in the
/// results (pixels_filled over pixels_rendered).

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Is there a budget of time that asks for it?
bool measures_depth(const Pipeline& pipeline);

/// Adds the layers that first appear in this frame. Cost: O(their triangles), once in a run.
void measure_depth(const Pipeline& pipeline, PipelineState& state, const FrameReport& report);

/// Texels of the sprite that the triangles of the layer which face the eye would fill, each by itself.
double texels_filled(const Pipeline& pipeline, const layers::SceneFrame& frame, const layers::Layer& layer,
                     const layers::SpritePlacement& placement);

}  // namespace talisman::sequences
