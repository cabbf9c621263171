// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How does a light look at the casters? The views of shadow maps (chunker/shadow_map.h).
///
/// A directional light's view is fitted to the casters, but its texels lie on a grid that is fixed in the
/// world: with l, r, d the light's axes (forward, right, down) and t the side of a texel, a point p is at
///
///   x = r·p / t - x₀,   y = d·p / t - y₀,   z = l·p - z₀      x₀, y₀, z₀ / t whole numbers
///
/// and t is not the size that just fits but the next of sixteenths of a power of two (6 … 13 % apart). So
/// when casters move, the shadow's edge of what rests stays where it is, to the bit, and the edge of what
/// moves goes on by whole texels; only where the fitted size passes one of those steps does the grid change
/// at all. The price is that a map shows up to 14 % more than it must, on each side.

///
/// So it is with the one view of a light in a place towards its casters: it looks along the direction to their
/// centre, rounded to eighths of its width, and takes in the next sixteenth of a power of two; as long as neither
/// passes a step, what casters do moves no texel.

#include <optional>

#include "chunker/transform.h"
#include "layers/scene.h"

namespace talisman::chunker {

/// Two directions across `forward` (unit length), right and down.
struct LightAxes {
  layers::dvec3 right, down, forward;
  layers::dvec3 operator()(const layers::dvec3& p) const;  ///< coordinates of a point along them
};

LightAxes axes_along(const layers::dvec3& forward);

/// How one face of a map is drawn.
struct FaceView {
  SpriteView view;
  double texel_m = 0;  ///< side of a texel; perspective: per unit of z
  bool orthographic = false;
};

/// The least of the sixteenths of a power of two that is no smaller than `size` > 0.
double stepped(double size);

/// `forward` (unit length), rounded for a view that takes in `tan_half` > 0 on each side of it.
layers::dvec3 steady_direction(const layers::dvec3& forward, double tan_half);

/// From a place: what lies within `tan_half` of the axis on each side.
FaceView perspective_view(const layers::ShadowMapOptions& options, const layers::dvec3& eye,
                          const LightAxes& axes, double tan_half, double near_w);

/// Of casters within lo … hi, coordinates along the axes; empty where they have no extent.
std::optional<FaceView> orthographic_view(const layers::ShadowMapOptions& options, const LightAxes& axes,
                                          const layers::dvec3& lo, const layers::dvec3& hi);

}  // namespace talisman::chunker
