// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where on a display is what is in a box? Its eight corners, homogeneous, so that what is outside of the view is
/// told from what is behind the eye (regulator/chunk_refresh.h).

#include <array>
#include <span>

#include "regulator/chunk_refresh.h"

namespace talisman::regulator {

inline constexpr std::size_t kBoxCorners = 8;
using BoxCorners = std::span<const layers::dvec3, kBoxCorners>;

inline BoxCorners corners_of(const std::vector<layers::dvec3>& corners, std::size_t box) {
  return BoxCorners(corners.data() + kBoxCorners * box, kBoxCorners);
}

/// Of all boxes, eight each.
std::vector<layers::dvec3> box_corners(const LayerContent& content, const ContentView& seen);

/// The same under an affine map of the display.
layers::dvec3 mapped(const layers::Affine2& map, const layers::dvec3& place);

enum class BoxSight {
  Outside,    ///< of the rectangle, or nearer than the near plane, all of it
  Unbounded,  ///< it may meet the rectangle, and reaches through the near plane, or is not a number
  Inside,     ///< it may meet the rectangle
};
struct BoxReach {
  BoxSight sight = BoxSight::Outside;
  layers::RectD
      bounds;  ///< of what meets the rectangle, but no less than of all where all is before the near plane
};
/// Of the box under `map`, and a rectangle from (0, 0) to `size`, grown by `margin` on each side.
BoxReach box_reach(BoxCorners corners, const layers::Affine2& map, layers::dvec2 size, double margin,
                   double near_m);

/// Of its corners before the eye, whatever they meet.
layers::RectD box_bounds(BoxCorners corners, const layers::Affine2& map);

/// The chunks of a grid that bounds, a texel around them included, lie in.
ChunkRect chunks_in(const layers::RectD& bounds, layers::ivec2 count);

/// Bound of the distance of what is in the box in one place and in the other; kHugePx where there is none.
double apart_px(BoxCorners corners_a, const layers::Affine2& map_a, BoxCorners corners_b);

}  // namespace talisman::regulator
