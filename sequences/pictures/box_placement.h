// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where do labels go, so that none lies over another?
///
/// Boxes are placed one after the other, each as near to its wish as it can be: inside the area, and clear of
/// the obstacles and of the boxes before it. *Near* is the distance of the upper left corners, in pixels;
/// with several wishes the nearest to any of them, of equally near ones that of the first wish.
///
/// The free places of a box among rectangles are the area without rectangles. The nearest of them stands at
/// the column of the wish or at a side of a rectangle: in each of those columns the nearest free row is found.
/// Where a blocking box moves by a pixel, so does the box that it pushes aside, as a rule: labels of a film
/// do not jump by rows.
///
/// Pure: the same input gives the same places. Places are whole pixels.

#include <optional>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::sequences {

struct BoxWish {
  layers::ivec2 size_px{0, 0};      ///< ≥ 0 in both directions
  std::vector<layers::dvec2> at{};  ///< of the upper left corner; what is not finite is no wish
};

/// Is there a pixel that both have?
bool overlap(const layers::RectI& a, const layers::RectI& b);

/// One per wish, in its order; empty where there is no room, or no wish. Coordinates of `area` and
/// `obstacles` at most 2^29. Cost: for each box at most O(n² log n) for n obstacles and boxes before it.
std::vector<std::optional<layers::RectI>> place_boxes(const layers::RectI& area,
                                                      const std::vector<layers::RectI>& obstacles,
                                                      const std::vector<BoxWish>& wishes);

}  // namespace talisman::sequences
