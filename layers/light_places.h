// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where on a body does a light draw something that has an outline of its own?
///
/// A spot that crosses a floor lights none of its corners, and a highlight is small beside the face on which it
/// lies. Their outlines are traced on the hull that stands for the body, in the world:
///
///   spot       the axis, and kRing rays where the cone's light is half: cos = (cos inner + cos outer) / 2
///   point      on each face: the foot of the light, and kRing rays about it at 45°, where N·L is 0.7
///   highlight  on each face: where the eye's mirror image sees the light, and kRing places about it where
///              (N·H)ⁿ is a half
///
/// A ray ends at its first crossing of the hull, in whichever direction that faces: the lamp inside a room
/// lights its walls. The normal of a place faces the light. An outline of which nothing is on the body has no
/// places. The terminator of a curved body lies between material points (layers/surface_samples.h), which are
/// spread by their normals too.

#include <array>
#include <span>
#include <vector>

#include "layers/point_shading.h"
#include "layers/surface_samples.h"

namespace talisman::layers {

inline constexpr int kRing = 12;

/// The triangles of one convex body, in the world; their normals may point in or out.
struct BodySurface {
  std::span<const dvec3> points;
  std::span<const std::array<int, 3>> triangles;
};

/// The places of one light, appended. Ambient light has none, directional light only highlights. Cost:
/// O(triangles · rays): 1 µs for a spot on a box.
void append_light_places(const LightState& light, const dvec3& eye, const MeanSurface& surface,
                         const BodySurface& body, std::vector<SurfacePlace>& places);

}  // namespace talisman::layers
