// SPDX-License-Identifier: Apache-2.0
#pragma once

/// When does a sprite that is shown enlarged become sharp again, once the motion is over?
///
///   at rest    the layer's state was N frames in a row, this one the last, that of the frame before, by
///              layers::LayerState::same_pixels: camera, nodes, joints, lights, and what casts on it or is mirrored.
///              If it moved last in frame e (and e + 1 shows the same), that is so from frame e + N on
///   enlarged   m r > 1 + kUnseenEnlargement        m: Sampling::magnification, what a texel is stretched to by the
///              warp, by a lower resolution of the sprite and by sampling along a motion; r: the resolution at which
///              it would be drawn now
///   settles    both, with N = settle_frames ≥ 1, and drawing it would change something
///
/// A layer that settles is drawn again as of this frame. Then it is no longer enlarged, so it is drawn once, until
/// something moves again. Policies Threshold, Lookahead, Oracle and Budget ask for it, where nothing else asks for a
/// render; the author's maximum update rate and the budget of a frame bind it as any other render, but not the
/// cut-off of the benefit. Without this rule a blur within the thresholds stays for ever.

#include <string>

#include "regulator/plan.h"

namespace talisman::regulator {

/// One texel in a thousand: the rounding of a fit is far less, and nobody sees it.
inline constexpr double kUnseenEnlargement = 1e-3;

/// Valid for a layer in view that has a sprite.
bool settles(const LayerAssessment& layer, const RegulatorOptions& options);

/// "settled: at rest for 3 frames, magnification 1.2 > 1"
std::string settle_reason(const LayerAssessment& layer);

}  // namespace talisman::regulator
