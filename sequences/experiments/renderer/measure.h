// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does drawing these variants of a sequence take, side by side?
///
/// In every round every frame is drawn by every variant before the next frame comes, in one process: what the
/// machine does besides falls on all of them alike. A time is the median over the rounds of the mean over the
/// frames; its spread is the median deviation from it. Counters and pictures are those of the first round;
/// they are the same in all.
///
/// Either each frame is drawn from nothing (shadow maps and all sprites included), or a run goes through a
/// range of frames under its policy and begins with the first of them.

#include <vector>

#include "sequences/experiments/without_effect.h"
#include "sequences/files/image_io.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/quality.h"

namespace talisman::sequences {

struct Workload {
  std::vector<int> frames;    ///< ascending
  bool is_run = false;        ///< sprites are kept from frame to frame; frames must be consecutive
  std::vector<int> compared;  ///< of them, those whose pictures are kept
  int rounds = 3;             ///< ≥ 1; more make the median surer, time in proportion
};

struct WallTime {
  double median_ms = 0, spread_ms = 0;
};

struct Measured {
  int frames = 0;
  WallTime plan, render, composite, drawn;  ///< per frame; drawn: render and composite
  WallTime cpu;                             ///< of the processor, all threads: less at the mercy of others
  double modelled_ms = 0;                   ///< per frame, by the profile talisman-1996
  // Added up over the frames.
  std::int64_t renders = 0, polygons = 0,
               pixels = 0;  ///< sprites drawn; triangles; texels of their rectangles
  chunker::RenderCounters counters;
  ShadeCounters passes;
  // The most of any frame.
  std::int64_t sprite_bytes = 0, shadow_map_bytes = 0, texture_bytes = 0;
  std::vector<Image8> pictures;  ///< of the compared frames
  double per_frame(std::int64_t sum) const { return frames > 0 ? double(sum) / frames : 0; }
  std::int64_t memory_bytes() const { return sprite_bytes + shadow_map_bytes + texture_bytes; }
};

/// One result per variant, in their order. Memory: the pictures that are kept, and what the variants' sprites
/// and textures take. Scenes that variants share are prepared once.
std::vector<Measured> measure_variants(const std::vector<const Variant*>& variants, const Workload& workload,
                                       Progress& progress);
/// Steps that `progress` must have.
int steps_of(std::size_t variants, const Workload& workload);

struct PictureError {
  Quality quality;  ///< mean over the frames, PSNR of the mean squared error; largest difference of any
  double rms_code_values = 0;  ///< of 255
};
/// Same number of pictures (programmer error otherwise).
PictureError error_of(const std::vector<Image8>& shown, const std::vector<Image8>& truth);

}  // namespace talisman::sequences
