// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Each sprite's outline, coloured by age, drawn on the frame (the boxes of [LS97 Fig. 24]):
/// re-renders can be seen.
///
/// Lines are antialiased and about 3 px wide. A perspective map keeps straight lines straight, so an edge is
/// clipped once, in homogeneous coordinates, to the picture and to denominators above 0; what is behind the
/// viewer, singular or not a number is not drawn. Labels stand on a dark ground at the first corner in view,
/// are moved into the picture, and step aside for labels already there.
///
/// A fresh sprite flashes white; then the colour runs from green (young) over yellow to red (old:
/// `oldest_frames` and more).

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

struct Outline {
  layers::dmat3 screen_from_sprite{1.0};
  layers::ivec2 size_px{0, 0};
  int age_frames = 0;  ///< 0: rendered for this frame
  std::string label;   ///< layer name and age, drawn at a corner that is in view
};

/// The colour of an outline: white at age 0, then green over yellow to red.
std::array<std::uint8_t, 3> age_color(int age_frames, int oldest_frames);

/// Draws in order: later outlines lie over earlier ones, and all labels over all lines. `oldest_frames` ≥ 1.
/// Cost: O(length of the visible edges).
void draw_outlines(Image8& image, const std::vector<Outline>& outlines, int oldest_frames = 24);

}  // namespace talisman::sequences
