// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Each sprite's outline, coloured by age, drawn on the frame (the boxes of [LS97 Fig. 24]):
/// re-renders can be seen.
///
/// Lines are antialiased and about 3 px wide. A perspective map keeps straight lines straight, so an edge is
/// clipped once, in homogeneous coordinates, to the picture and to denominators above 0; what is behind the
/// viewer, singular or not a number is not drawn.
///
/// A label, "leader · 12 frames", stands on a dark ground at the highest corner of what is in view of its
/// sprite: it moves with it, stays in the picture, and steps aside for others by as little as can be
/// (box_placement.h). It does not depend on other frames, so that a part of a run is as the whole.
///
/// A fresh sprite flashes white; then the colour runs from green (young) over yellow to red (old:
/// `oldest_frames` and more). The legend in the lower left corner says so.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

struct Outline {
  layers::dmat3 screen_from_sprite{1.0};
  layers::ivec2 size_px{0, 0};
  int age_frames = 0;  ///< 0: rendered for this frame
  std::string label;   ///< layer name and age; empty: none
  int rank = 0;        ///< labels find their places in this order: the same for a layer in all frames
};

inline constexpr int kOldestFrames = 24;

/// "leader · new", "leader · 1 frame", "leader · 12 frames": frames since it was drawn.
std::string outline_label(const std::string& layer, int age_frames);

/// The colour of an outline: white at age 0, then green over yellow to red.
std::array<std::uint8_t, 3> age_color(int age_frames, int oldest_frames);

/// Draws in order: later outlines lie over earlier ones, and all labels over all lines. `oldest_frames` ≥ 1.
/// No label lies over `kept_free`, or over another, where there is room. Cost: O(length of the visible
/// edges), and O(n³) for n labels.
void draw_outlines(Image8& image, const std::vector<Outline>& outlines, int oldest_frames = kOldestFrames,
                   const std::vector<layers::RectI>& kept_free = {});

/// Where the legend stands; empty where the picture is too small for one.
std::optional<layers::RectI> legend_place(const Image8& image, int oldest_frames = kOldestFrames);
void draw_legend(Image8& image, int oldest_frames = kOldestFrames);

/// Outlines, their labels clear of the legend, and the legend.
void draw_overlay(Image8& image, const std::vector<Outline>& outlines, int oldest_frames = kOldestFrames);

}  // namespace talisman::sequences
