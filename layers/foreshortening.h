// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where between its corners does a surface move otherwise than an affine map of the corners says?
///
/// Display positions are not linear in the barycentric coordinates of a triangle, clip coordinates are. Along
/// an edge from a to b, with w the depths then and w' now, the place that is at the share s of the edge on the
/// display then is now at the share
///
///   u(s) = s r / (1 + s (r - 1)),        r = (w'_b / w_b) / (w'_a / w_a)
///
/// of it: where the depths have not kept their ratio, the corners' motion does not explain what lies between
/// them, however exactly a warp carries the corners. The difference is largest at
///
///   s* = 1 / (1 + √r),   and there is   |u - s| = |√r - 1| / (√r + 1)                    [du/ds = 1]
///
/// times the edge's length on the display now, in pixels. A ground plane that the camera flies over shows it:
/// right at its four corners, it is off by pixels in its middle. The places of these maxima are material points
/// like the corners, to be fitted and judged with them; a body whose depths keep their ratio to less than
/// kLeastBow_px has none of them, and pays for a minimum and a maximum.

#include <vector>

#include "layers/clip.h"

namespace talisman::layers {

inline constexpr double kLeastBow_px = 0.25;
/// Those with the largest bows stand for the others.
inline constexpr std::size_t kMostBowedPlaces = 24;

/// The largest difference along an edge: its share of the edge on the display then, and how much, in shares of
/// the edge now. `ratio` is r > 0.
struct Bow {
  double at = 0.5;
  double share = 0;
};
Bow bow_of(double ratio);

/// Whether any edge between points whose now.w / then.w lie in least … most can bow by kLeastBow_px on a
/// display on which they are `apart_px` from each other at most.
bool can_bow(double least_ratio, double most_ratio, double apart_px);

/// The material points at the largest differences along the edges and chords of polygons, of kLeastBow_px and more,
/// each place once, the largest first, at most kMostBowedPlaces. All w > 0 in both states, then and now. Cost:
/// O(corners) where nothing bows, O(chords) else.
std::vector<MaterialPoint> bowed_places(const PolygonList& polygons, ivec2 display_px);

}  // namespace talisman::layers
