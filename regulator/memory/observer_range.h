// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where may the eye be, and look, within the next frames [Fu93 5.2.1, 5.2.2]?
///
/// It moves by at most v metres and turns by at most w radians a frame, so after n of them it lies within n v of where
/// it is, in whichever direction. With cells it goes through portals alone: Dijkstra's search over them, whose key
///
///   d(portal) = max(d(portal before) + gap between the two, gap between eye and portal)      gap: of the boxes around them
///
/// is never more than the way the eye has to go, and a cell is entered after d / v frames. A cell that `RangeCull` throws out
/// is not searched beyond.
///
/// Without cells nothing hides, and what may be seen within n frames meets the cone of half angle
///
///   γ + n w        γ: from the view's axis to the corners of the display
///
/// around a ball of radius n v: a ball of radius r at distance d and angle φ from the axis does if φ ≤ γ + n w + asin((r + n v) / d), or
/// d ≤ r + n v. [Fu93] widens the four half angles of the frustum instead; near its corners a turn of w leaves that by
/// more than w, so that it is no bound.

#include <span>
#include <vector>

#include "layers/cells.h"
#include "layers/region.h"
#include "layers/scene.h"
#include "regulator/memory/prefetch_options.h"

namespace talisman::regulator {

/// A ball.
struct Ball {
  layers::dvec3 middle{0, 0, 0};
  double radius_m = 0;
};
/// Around a box; around everything, of infinite radius, for kEverywhere.
Ball ball_around(const layers::Box3& box);

/// Who looks, and how fast that can change.
struct Observer {
  layers::dvec3 eye{0, 0, 0}, forward{0, 0, -1};  ///< of unit length
  double half_diagonal_rad = 0;                   ///< γ
  double focal_px = 1;                            ///< of a thing of 1 m at 1 m
  double display_px2 = 1;                         ///< all there is
  layers::Region view;                            ///< layers::view_region
  double step_m = 0, turn_rad = 0;                ///< v and w, of one frame
};
Observer observer(const layers::CameraState& camera, layers::ivec2 display_px, const PrefetchOptions& options,
                  double fps);

/// A cell that the eye may enter, and after how many frames at the soonest; 0: it is in there.
struct RangeCell {
  int cell = -1;
  double frames = 0;
};

/// By the frames, those of one instant by their number: those around the eye, whatever the cull says, and those that it
/// may enter within options.frames. Cost: O(portals² / cells · log) of what is reached.
std::vector<RangeCell> range_cells(const layers::CellSet& set,
                                   const std::vector<std::vector<int>>& portals_of,
                                   std::span<const int> around_eye, const Observer& observer,
                                   const PrefetchOptions& options);

/// Does the box pass? Each errs on the side of what may be seen.
bool passes(RangeCull cull, const layers::Box3& box, const Observer& observer);
bool passes(LookaheadCull cull, const layers::Box3& box, const Observer& observer);

/// The least n in 0 … most after which the ball may be seen, were there nothing that hides it; most + 1: not by then.
int frames_until_in_view(const Ball& ball, const Observer& observer, int most);

/// From the eye to what is nearest of the box, m.
double gap(const layers::Box3& box, const layers::dvec3& p);
double gap(const layers::Box3& a, const layers::Box3& b);

}  // namespace talisman::regulator
