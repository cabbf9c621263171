// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman accuracy --renderer` has measured: of every rung of every knob, and of every effect, what
/// it costs and what it buys (experiment.h). Data alone: what prints it looks down on it.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "chunker/render.h"
#include "layers/effects.h"
#include "sequences/experiments/renderer/knobs.h"
#include "sequences/files/image_io.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/step.h"

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

struct PictureError {
  Quality quality;  ///< mean over the frames, PSNR of the mean squared error; largest difference of any
  double rms_code_values = 0;  ///< of 255
};

/// NaN where there is none.
struct Gain {
  double db_per_ms = NAN, flip_per_ms = NAN;
};

struct RungResult {
  std::size_t knob = 0, rung = 0, variant = 0;
  PictureError error, alone;  ///< against the truth; of the knob alone
  double work = 0;            ///< of the knob's WorkKind, per frame
  Gain gain;                  ///< relative to the rung before; none for the first
  bool work_front = false;    ///< no other rung of its knob has as little FLIP for as little work
  bool wall_front = false;    ///< … for as little measured time
};

struct KnobResults {
  RendererLadder ladder;
  std::vector<int> frames;
  std::vector<Measured> measured;  ///< by variant
  std::vector<RungResult> rungs;   ///< knob by knob
};

struct EffectResult {
  layers::EffectCall call;
  std::size_t without = 0;  ///< index into EffectResults::frames or ::runs; 0 is with all effects
  /// Of a picture effect: without against with. Else without against its own `direct`.
  PictureError error;
};

struct EffectResults {
  Workload frame_load, run_load;
  std::vector<Measured> frames, runs;  ///< [0]: with all effects
  std::vector<EffectResult> pictures;  ///< effects of a single frame
  std::vector<EffectResult> over_time;
  PictureError run_error;  ///< with all effects, against `direct`
  std::vector<layers::EffectCall> not_called;
};

struct RendererReport {
  Settings given;  ///< what is not varied is as it is here
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  int rounds = 0;
  std::string policy;  ///< of the runs
  KnobResults knobs;
  EffectResults effects;
};

}  // namespace talisman::sequences
