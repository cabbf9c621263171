// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does it cost that the compositor has only `over`, what do coarse shade layers cost, and what old
/// ones? And what does factoring save?
///
/// The truth of a frame is unfactored: every layer that has shade layers is drawn by the definition, ambient +
/// emission + Σ v (D + S) + reflection per channel, in one pass that nothing is rounded in, texel on pixel; all
/// layers are composited in exact arithmetic in the order of `reference`. Layers that factor nothing, and
/// those that are merged in a cycle (they are drawn in one pass), are their own truth. Against it, frame by
/// frame, each with one thing more:
///
///   over alone          every layer in every frame, all sprites at full resolution, texel on pixel
///   + shade resolution  shade layers at the sequence's own resolutions
///   + placement         all sprites where and as dense as the sequence has them: rotated, blurred by motion,
///                       compressed, coarser where their authors say so
///   + reuse             the sequence's own policy
///
/// and, for comparison, every way of factoring shadows (layers/shading.h) as `over alone` is drawn: as shade, light,
/// multiply and atop, the last two with the extended compositor (multiply, which does not go with factored
/// textures, with those in their surface: judged by the truth that blends them so); and the same layers
/// unfactored in one pass of the renderer, fresh and under the sequence's policy. All else with the compositor that
/// has `over` alone, whatever the sequence says. One pass gives each of a texel's 16 samples its own shadow,
/// shade multiplies means: where a texel is mixed that is a part of its error.
///
/// The loss of `over alone` is predicted (prediction.h), of the frame and of each layer as if it alone
/// were factored, and compared with what the compositor made.

#include <vector>

#include "sequences/experiments/factoring/measured.h"
#include "sequences/experiments/variant.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// The layers of `report`, which was drawn of `flush` (texel_on_pixel, full resolution) with `state` after
/// it, and their truth from `whole` (the same, unfactored). `constant_blend`: textures are blended as
/// materials say, as the unfactored sequence has them. Sprites of layers that factor nothing stay in `state`.
std::vector<ShadedLayer> shaded_layers(const Pipeline& flush, const Pipeline& whole,
                                       const PipelineState& state, const FrameReport& report,
                                       const chunker::PreparedScene& prepared, bool constant_blend);

/// `variant` must be factored. Cost: each sampled frame about ten renderings and as many comparisons.
FactoringResult measure_factoring(const Variant& variant, const ExperimentFrames& frames,
                                  ProgressKind progress);

}  // namespace talisman::sequences
