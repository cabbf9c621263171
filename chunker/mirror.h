// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a planar mirror show? [LS97 2.3, Fig. 5: "a separate rendering with a reflected camera"]
///
/// The camera is reflected in the plane n · p = d:  M = [I - 2 n nᵀ, 2 d n],  world_from_camera' = M ·
/// world_from_camera. A point of the mirror has the same place on the display in both views, so a fragment of
/// the mirror looks its reflection up at its own screen position. The reflected camera is left-handed; the
/// renderer keeps fronts fronts. One bounce only: what a mirror shows in this mirror is its own colour.

#include "chunker/clip.h"
#include "layers/scene.h"

namespace talisman::chunker {

/// `frame` with its camera reflected. A normal without direction, or a plane that is not finite, leaves the
/// camera as it is. A plane through the eye is no exception: the mirror is then seen edge-on.
layers::SceneFrame mirrored_frame(const layers::SceneFrame& frame, layers::dvec3 point, layers::dvec3 normal);

/// What the mirror can show: the half-space on the eye's side, whichever side of the plane that is (a mirror
/// may be two-sided). What lies behind the mirror is not mirrored, also of a part that reaches through it;
/// draw the mirrored frame with this as ShadeInputs::kept. `frame` is not mirrored. Empty where the plane is
/// not finite or the normal has no direction.
std::optional<HalfSpace> before_mirror(const layers::SceneFrame& frame, layers::dvec3 point,
                                       layers::dvec3 normal);

}  // namespace talisman::chunker
