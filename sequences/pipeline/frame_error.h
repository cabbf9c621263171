// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How wrong is a frame, over all of its layers? [LS97 Fig. 23]
///
///   mean            Σ eᵢ / n              over the layers in view
///   by pixels       Σ aᵢ eᵢ / Σ aᵢ        over the sprites shown
///
/// eᵢ: the geometric error of what is displayed of layer i, px; aᵢ: the area of the display that its sprite's
/// rectangle covers where it is shown, px². The paper draws the first: a far bush counts as much as the ground.

#include "layers/geometry2.h"
#include "sequences/pipeline/frame_report.h"

namespace talisman::sequences {

/// Both are warp::kHugePx where a layer is displayed whose error has no bound.
struct FrameError {
  double mean_px = 0;            ///< 0 where nothing is in view
  double mean_by_pixels_px = 0;  ///< 0 where no sprite covers anything
};

FrameError error_of(const FrameReport& report);

/// The area of the display that a sprite of this size covers, px². What a perspective map throws behind the eye
/// covers nothing. O(1).
double covered_px(const layers::dmat3& screen_from_sprite, layers::ivec2 size_px, layers::ivec2 display_px);

/// How many sprites lie over a pixel of the display, mean over the display.
double sprite_depth(const FrameReport& report);

}  // namespace talisman::sequences
