// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Has a side at which the sprite was cut off come into view? [LS97 5.4]
///
/// A sprite ends where the layer ends, or where its extents cut it off. What lies beyond a cut side was never
/// drawn. With the side carried along by the warp, the missing picture is the part of the display that lies
/// beyond it, within the layer's outline now (the convex hull of its points on the display, which is the same
/// there however far the extents reach) and across from the side:
///
///   uncovered = display ∩ outline now ∩ outer half-plane of the warped side ∩ strip over the side
///   depth     = largest distance of uncovered from the side, less the same at the instant of rendering, px
///
/// At rest the two terms are equal. They are not always zero: the outline is that of a polyhedron around the
/// content.

#include "fiducials/fiducials.h"

namespace talisman::fiducials {

/// Cost: nothing when no side was cut; else O(n log n) in the points of the outline, about a µs.
Visibility visibility_of(const layers::LayerState& then, const layers::LayerState& now,
                         const layers::SpritePlacement& placement, const warp::Warp& warp);

}  // namespace talisman::fiducials
