// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The outline of a layer on the display, as a convex polygon.

#include <span>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::layers {

/// The convex hull of finite points, each corner once (a point gives one, a line two), by a monotone chain.
/// Cost: O(n log n).
std::vector<dvec2> convex_hull(std::vector<dvec2> points);

/// The part of a convex polygon inside a closed rectangle; works for a point and a line too. Cost:
/// O(corners).
std::vector<dvec2> clip_to_rect(std::vector<dvec2> polygon, const RectD& rect);

}  // namespace talisman::layers
