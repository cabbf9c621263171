// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The third sprites of a frame: fresh ones mixed with those that fade out (chunker/cross_fade.h), as the plan says
/// (cross_fading.h); and all sprites of a frame as they are composited.

#include <map>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// By layer id; empty where nothing fades. They live as long as their frame.
using BlendedSprites = std::map<int, chunker::Sprite>;

/// All sprites that the frame shows and those that fade out are drawn.
BlendedSprites blended_sprites(const PipelineState& state, const FrameReport& report);

/// A sprite in its place, as the compositor takes it. Keeps pointers into `sprites` and `blended`.
chunker::PlacedSprite placed_sprite(const ShownSprite& shown, const chunker::SpriteStore& sprites,
                                    const BlendedSprites& blended);

}  // namespace talisman::sequences
