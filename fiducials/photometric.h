// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How wrong is the light on the old sprite? [LS97 4.3, 5.2]
///
/// Both ways of the paper, over the characteristic points (points p, normals n, colours C; ^ at `then`):
///
///   point-sampled   F = maxᵢ ‖Cᵢ - W_C Ĉᵢ‖,   W_C = the least-squares multiplier of warp/color.h, 0 … 1
///   light source    θ = max over lights of the angle between R (L̂ - ĉ) and L - c
///
/// c is the middle of a body's points, R the body's turn since `then`: what counts is the motion of the light
/// relative to the layer. Directional lights have only an angle. A light closer than kCloseRadii times the
/// body's radius has no direction that holds for the whole body; for it
///
///   θ = ‖R (L̂ - ĉ) - (L - c)‖ / max(radius, smaller distance)
///
/// which is the angle again at the border (to θ²/24 of it, at constant distance) and small for a light that
/// makes a small step through the middle.
/// Layers with highlights count the eye as one more light. The largest θ over bodies is given.
///
/// What the colour warp can do is what the compositor can: darken. Where the light on a layer grows the
/// multiplier stays 1 and F says what is missing; so a sprite is best drawn as of the brightest instant of a
/// run, which is what the policies that look ahead find.
///
/// The points are the characteristic points and, where light can fall between them, places on the surface
/// itself: material points, outlines of cones, feet of point lights and highlights as they were and as they are
/// (fiducials/lit_places.h). A spot that crosses a floor and lights none of its corners is found so. On a body
/// that is not flat the outlines lie on its polyhedron, and material points stand for what is between them: an
/// estimate there.
///
/// Normals are those of the polyhedron and the meshes. Under a normal map the pixels of a surface are lit by others,
/// which lean to all sides about them: for such a layer both forms are an *estimate*. A light that moves changes
/// single bumps by more than F says, up to the whole of its colour where they lean by the angle that it lacks, and
/// in other directions, so that no multiplier mends it; in the mean over the bumps F is about right, as long as
/// they lean little. θ does not depend on normals: `light_angle_rad` bounds how far the light of a bump may turn.
///
/// Points whose normal faces away from the eye in both states are not seen and do not count, unless that is
/// so for all of them (the eye is inside the polyhedron). The light source form knows nothing of a light that
/// changes its colour; the point-sampled form does.

#include "fiducials/fiducials.h"
#include "layers/polyhedron.h"

namespace talisman::fiducials {

/// A light is close below this many radii of the body: nearer, its direction differs by 30° and more across
/// the body.
inline constexpr double kCloseRadii = 4;

struct PhotometricOptions {
  bool color_warp = true;  ///< false: W_C is the identity [LS97 5.2, footnote 9]
};

/// Not computed, with the reason, where the bound has no surface, or a state has no points. Cost: nothing
/// where not computed; else O(points + lights · bodies), about 0.9 µs for a box under three lights.
Photometric photometric_of(const layers::LayerState& then, const layers::LayerState& now,
                           const layers::LayerBound& bound, const PhotometricOptions& options = {});

/// θ of a light (or eye) at these offsets from a body's middle, the first already turned with the body. 0 for
/// equal offsets, π at most and where an offset is not finite.
double position_change_rad(const dvec3& then_offset, const dvec3& now_offset, double radius);

/// The angle between two directions, 0 for equal ones, π where one has no length or is not finite.
double angle_between_rad(const dvec3& a, const dvec3& b);

}  // namespace talisman::fiducials
