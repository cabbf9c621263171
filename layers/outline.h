// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The outline of a layer on the display, as a convex polygon.

#include <span>

#include "layers/geometry2.h"
#include "layers/inline_vector.h"

namespace talisman::layers {

/// Room for the outline of a 26-direction polyhedron that is cut on all sides.
using Polygon2 = InlineVector<dvec2, 32>;

/// The convex hull of finite points, each corner once (a point gives one, a line two), by a monotone chain.
/// Cost: O(n log n).
Polygon2 convex_hull(std::span<const dvec2> points);

/// The part of a convex polygon inside a closed rectangle; works for a point and a line too. Cost:
/// O(corners).
Polygon2 clip_to_rect(const Polygon2& polygon, const RectD& rect);

/// Keeps the part of a convex polygon where normal · p ≥ offset (Sutherland & Hodgman).
Polygon2 clip_to_half_plane(const Polygon2& polygon, dvec2 normal, double offset);

/// Of a convex polygon; 0 for a point or a line.
double area_of(const Polygon2& polygon);

}  // namespace talisman::layers
