// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which sides of a layer have turned to the eye since its sprite was drawn? [LS97 5.4]
///
/// The faces of the characteristic polyhedron stand for the sides of the layer. A face with outer normal a
/// (its length twice the face's area) and corner p faces the eye e where
///
///   s = a · (e - p) / (‖a‖ ‖e - p‖) > 0
///
/// A side with ŝ ≤ kEdgeOn that faces the eye now shows content that the sprite does not have. How much of
/// the display it takes is what counts: a face that has only just turned takes nearly none, so that the
/// figure grows steadily from 0 and does not flicker with the rounding of ŝ. Faces without area (those
/// between the two sides of a flat layer) never turn.

#include "fiducials/fiducials.h"
#include "layers/polyhedron.h"

namespace talisman::fiducials {

/// s up to here is edge-on, whatever its sign: rounding. Nor has a face with less than this share of the
/// largest face's area a side to be seen.
inline constexpr double kEdgeOn = 1e-6;

/// Not computed, with the reason, where the states have no points or were captured without the frames of
/// their bodies (LayerBound::follows_faces). Cost: O(triangles of the hull), about 0.4 µs for a box; more
/// only for the faces that have turned.
TurnedFaces turned_faces_of(const layers::LayerState& then, const layers::LayerState& now,
                            const layers::Polyhedron& hull);

}  // namespace talisman::fiducials
