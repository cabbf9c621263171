// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A frame that lasts: the mean of M pictures over its time, as an accumulation buffer makes motion blur [F96 3.2.4].
///
///   picture j of frame f is that of the instant (f + j / M) / fps, j = 0 … M - 1: the shutter is open all the time
///   mean      in linear light, per channel and pixel: ⌊Σ / M + ½⌋ of 16 bits
///
/// The pictures of a run are frames of one with M times the rate, and so is their plan: what changes within a frame is drawn each
/// time, and what is slow once for a whole slice. Policies Direct and Predictive; with δ = 0 and one sample for each pixel both
/// give the same bytes. It is the truth of the effect motion_blur (sequences/pipeline/motion_blur.h), which samples a
/// sprite along its mean motion: as M grows, what a layer that moves as a whole should look like.
///
/// Costs and counters are those of all M pictures. What a decision says of a layer is added up over them.

#include <functional>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The most pictures of a frame.
inline constexpr int kMostAccumulated = 256;

/// Of a run whose frames are the pictures of this one.
Pipeline pipeline_of_pictures(const Pipeline& pipeline);

/// Frame `frame` of `pipeline`, from `step` of the pictures in their order.
FrameReport accumulated_step(const Pipeline& pipeline, int frame,
                             const std::function<FrameReport(const Pipeline&, int picture)>& step);

/// The mean of the pictures of `frame`, in any order.
chunker::Frame accumulated_picture(const Pipeline& pipeline, int frame,
                                   const std::function<chunker::Frame(const Pipeline&, int picture)>& draw);

}  // namespace talisman::sequences
