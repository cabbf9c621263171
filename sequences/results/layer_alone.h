// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One layer by itself, without what hides it: as a frame shows it, and as it would be drawn fresh. What an audit and
/// an explanation compare.

#include "chunker/composite.h"
#include "chunker/render.h"
#include "sequences/pictures/image_drawing.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The sprite alone, over nothing. A Light layer, which covers nothing, covers as much as it gives of the brightest channel;
/// the Shadow layer of one light, which is black, is white; that of all lights, which is what is left of them, is what
/// it takes away. So all are seen by themselves.
chunker::Frame shown_alone(const chunker::Sprite& sprite, const layers::dmat3& screen_from_sprite,
                           const SpriteMultipliers& multipliers, const layers::Layer& layer,
                           layers::ivec2 display_px);

/// The layer as `reference` shows it in the frame of `report`, after the step that made it, with the state that it
/// left. Cost: one drawing of the layer.
chunker::Frame fresh_alone(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                           int layer, const chunker::PreparedScene& prepared);

/// A part of such a frame over grey, so that black and white silhouettes are seen.
Image8 over_grey(chunker::Frame frame, const Crop& crop);

}  // namespace talisman::sequences
