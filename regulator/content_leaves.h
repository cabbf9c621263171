// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Boxes of content, cut so small that each is a place on the display. A box near the eye may span all of it, and what
/// is at its near corners, off the display, says nothing of what is seen; so it is halved along the edge that is longest on
/// the display, until none is longer than kLeafExtent_px or it was halved kMostHalvings times. What is off the display is
/// not halved.
///
/// Corners of a part of a box are linear in those of the box, also as homogeneous places: at another instant they follow
/// from the box's corners then.

#include <array>
#include <vector>

#include "regulator/box_places.h"

namespace talisman::regulator {

inline constexpr double kLeafExtent_px = 64;
inline constexpr int kMostHalvings = 8;

using Corners = std::array<layers::dvec3, kBoxCorners>;

/// A part of a box: along each of its edges from lo to hi, 0 … 1.
struct ContentLeaf {
  std::size_t box = 0;
  layers::dvec3 lo{0, 0, 0}, hi{1, 1, 1};
  Corners now;              ///< where it is on the display
  bool on_display = false;  ///< part of it may be
};

Corners corners_of_part(BoxCorners box, const layers::dvec3& lo, const layers::dvec3& hi);

/// Of all boxes, with their corners now. Cost: O(boxes + display / kLeafExtent_px²).
std::vector<ContentLeaf> content_leaves(const std::vector<layers::dvec3>& now, layers::ivec2 display_px,
                                        double margin_px, double near_m);

}  // namespace talisman::regulator
