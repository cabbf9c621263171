// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The last warp of a late run, and its judge.
///
/// Just before a frame is shown later poses are known than when it was decided and drawn (late_camera.h). Each sprite is then
/// carried to where its layer is as the camera of the last warp W sees it:
///
///   screen ← warp(then → now under W) · placement       the family of the layer's warp, fitted anew from the state as of which
///                                                       the sprite was drawn
///
/// so of policy `hold`, too, whose pictures stand for its decisions. A frame without sprites is one picture of camera D, and is
/// turned as a whole, as if all were infinitely far: K R_W⁻¹ R_D K⁻¹, one homography. What comes into view then is not there.
///
/// The truth is the true camera at t. Of a layer that is shown, true_px is the largest distance of its characteristic points
/// from where that camera sees them: points that are in both views (layers/state.h). Things in the scene are as of t
/// throughout. Of policy `predictive` it is what its camera is off; its own error, at most geometric_px, comes on top.

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Degrees between two cameras' directions and rolls.
double degrees_between(const layers::CameraState& a, const layers::CameraState& b);

/// How a picture of `drawn` moves as `shown` sees it where all is infinitely far, in pixels of a display of this size.
layers::dmat3 turned_picture(const layers::CameraState& drawn, const layers::CameraState& shown,
                             layers::ivec2 display_px);

/// Carries what a late frame shows, and judges it; nothing to do for other runs.
void show_late(const Pipeline& pipeline, PipelineState& state, FrameReport& report);

}  // namespace talisman::sequences
