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

/// One face of a body: a plane, and the triangles on it.
struct HullFace {
  dvec3 a{0}, ab{0}, ac{0}, normal{0};
  bool is_flat = false;              ///< it has no area
  double radius = 0;                 ///< of the face about `a`
  double least_side = 0;             ///< of its triangles, at their first corners
  std::size_t first = 0, count = 0;  ///< of the body's triangles
  double height(const dvec3& p) const;
};

/// One convex body, in the world, as rays meet it. Its normals may point in or out. A plain value: what it was made of is
/// not kept. Cost: O(triangles); 0.3 µs for a box.
class BodySurface {
 public:
  BodySurface(std::span<const dvec3> points, std::span<const std::array<int, 3>> triangles);

  struct Triangle {
    dvec3 a, ab, ac;
    double edge_on = 0;  ///< below this determinant a ray sees only its edge
  };
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<HullFace>& faces() const { return faces_; }
  /// True: the ray misses an enclosing sphere by more than rounding can bring it there. `way` has unit length.
  bool is_missed_by(const dvec3& from, const dvec3& way) const;

 private:
  HullFace face_from(std::size_t first) const;

  std::vector<Triangle> triangles_;
  std::vector<HullFace> faces_;
  dvec3 center_{0};
  double radius_ = 0;
};

/// Can a light draw such an outline on this surface at all?
bool draws_outlines(const LightState& light, const MeanSurface& surface);

/// The places of one light, appended. Ambient light has none, directional light only highlights. Cost:
/// O(triangles · rays that meet an enclosing sphere): 1 µs for a spot on a box.
void append_light_places(const LightState& light, const dvec3& eye, const MeanSurface& surface,
                         const BodySurface& body, std::vector<SurfacePlace>& places);

}  // namespace talisman::layers
