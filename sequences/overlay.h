// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Each sprite's outline, coloured by age, drawn on the frame (the boxes of [LS97 Fig. 24]): re-renders can
/// be seen. A fresh sprite flashes white; then the colour runs from green (young) over yellow to red (old:
/// `oldest_frames` and more).

#include <string>
#include <vector>

#include "sequences/image_io.h"

namespace talisman::sequences {

struct Outline {
  layers::dmat3 screen_from_sprite{1.0};
  layers::ivec2 size_px{0, 0};
  int age_frames = 0;  ///< 0: rendered for this frame
  std::string label;   ///< layer name and age, drawn at a corner that is in view
};

void draw_outlines(Image8& image, const std::vector<Outline>& outlines, int oldest_frames = 24);

}  // namespace talisman::sequences
