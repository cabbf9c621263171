// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What did each sprite contribute to a frame? An EXR with named channels, for tools that composite.
///
///   R, G, B                       the frame, linear light
///   background.R .G .B            what the background contributes
///   LAYER.R .G .B                 what the layer's sprite contributes:  S_k ∏ (1 - α_j)  over the sprites j before it
///   LAYER.age                     frames since it was drawn         where the sprite has a texel; else 0
///   LAYER.error                   geometric error, pixels           likewise
///   LAYER.id                      the layer's place in the author's order, from 1, aggregates behind; likewise
///
/// The sum of all contributions is the frame, within the 16 bits of the compositor and the 11 of a half float. Sprites
/// that are not shown have no channels. A layer's name stands as it is, but '.' and control characters become '_',
/// what is longer than 200 bytes is cut, and a name that is there already gets a number; `talisman:layers` in the
/// header is a JSON object from the names in the channels to those of the layers.

#include <string>
#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Only the part of the display that a sprite covers: all of them together may be larger than memory.
struct SpriteContribution {
  std::string channel;  ///< the part of its channels' names before the dot
  std::string layer;    ///< empty: the background
  int x0 = 0, y0 = 0, width = 0, height = 0;
  std::vector<layers::vec3> color;  ///< linear, row by row
  std::vector<bool> covers;         ///< likewise
  float age_frames = 0, error_px = 0, id = 0;
};

struct SpriteChannels {
  std::vector<SpriteContribution> sprites;  ///< the background, then back to front
};

/// Of a frame that was just drawn by sprites that are laid `over` each other (no policy Direct, no extended
/// compositor).
SpriteChannels sprite_channels(const Pipeline& pipeline, const PipelineState& state,
                               const FrameReport& report);

EncodedPicture encoded_exr(const chunker::Frame& frame, const SpriteChannels& channels);

}  // namespace talisman::sequences
