// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far has a body moved on the display, at most, if its old picture is shown where it was drawn? [F96 3.1.2]
/// Pure: from the clip-space positions of a few prediction vertices, whose convex hull holds the body.
///
/// The thesis takes the largest motion of a vertex. That bounds the motion of what is inside for affine cameras
/// only. With vertices v_i (px) of depths w_i, what is inside lies at p = Σ μ_i v_i, μ_i ~ λ_i w_i with λ fixed
/// in the body; when depths change by the factors r_i, μ_i becomes μ_i r_i / r̄, and
///
///   |p' - p| ≤ max |v'_i - v_i| + R · 2 (√ρ - 1) / (√ρ + 1),    ρ = max r_i / min r_i
///
/// with R half the extent of the v_i (or of the v'_i: the smaller counts). Proof: the first term bounds
/// Σ μ'_i (v'_i - v_i); the second Σ (μ'_i - μ_i)(v_i - c), where Σ μ_i |r_i / r̄ - 1| is largest for two
/// depths with mean √(r_min r_max). It is 0 for what keeps its depths, and small for what is small against its
/// distance. The same holds for each axis alone.
///
/// Depth is a part of the motion: what recedes while it grows keeps its outline and changes what it hides. In
/// pixels, as a motion across would be seen: focal length (px) · |ln r|, exact for what is inside.

#include <cstdint>
#include <span>
#include <string_view>

#include "layers/state.h"

namespace talisman::regulator {

/// Which motion may be δ at most?
enum class MotionNorm {
  Axis,    ///< along x and along y, as printed: up to √2 δ in all
  Euclid,  ///< in any direction
};
std::string_view name(MotionNorm norm);  ///< "axis", "euclid"

/// From clip space to pixels.
struct DisplayScale {
  layers::dvec2 half_px{1, 1};  ///< half the display
  double focal_px = 1;          ///< half its height over the tangent of half the field of view
  DisplayScale(const layers::CameraState& camera, layers::ivec2 display_px);
};

/// Bounds of the motion, in pixels, of all that is inside the hull of the vertices.
struct ProjectedMotion {
  bool bounded = false;  ///< false: a vertex is not in front of the eye in both states, or not finite
  double x_px = 0, y_px = 0;
  double px = 0;  ///< in any direction
  double depth_px = 0;
};

/// As many vertices in both, each the same place of the body. None: nothing moves.
ProjectedMotion projected_motion(std::span<const layers::dvec4> then, std::span<const layers::dvec4> now,
                                 const DisplayScale& scale);

/// Is the motion beyond δ ≥ 0? What has no bound is.
bool is_beyond(const ProjectedMotion& motion, double delta_px, MotionNorm norm);

/// Sides of the view on which all vertices, and so all of the body, lie outside: one bit each for left, right,
/// bottom, top and near. Not 0: nothing of it can be seen [F96 3.1.3]. Without vertices all of them.
std::uint8_t sides_outside(std::span<const layers::dvec4> clip);

}  // namespace talisman::regulator
