// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Beside its own parts, what determines the pixels of a sprite that holds shadows, highlights or
/// reflections; and where those lie on the surface.
///
/// The surface that stands for a receiver is its plane (Layer::plane) where it is flat, else the plane
/// through the centre of its characteristic points that faces the light. With light at l, eye e, its mirror
/// image e', characteristic point c of a caster or of a mirrored layer, the *places* on that surface are
///
///   shadow       where the ray from l through c meets it
///   highlight    where e' is seen from l (flat); centre + radius · (L + V) / |L + V| (not flat)
///   reflection   where the mirror image of c is seen from e
///
/// in the space of the receiver, so that places stand still while light, eye, casters and receiver move
/// together, and move only if a new picture would look different on the surface. A place that does not exist
/// (the caster above the light, the mirrored point behind the mirror) is NaN. What is above the light throws a shadow
/// without end: places along it, from the shadow of the nearest point below the light, stand behind the others. Of what a
/// mirror shows, the shadows on it and where its lights strike it are seen as well. A trace is `on_receiver` where
/// the bounds of its places, 10 % larger, meet those of the receiver, and a shadow only if it may fall there at
/// all (layers/casting.h): the ground below a ball does not cast on it.
///
/// Limits, stated: layers that deform are tracked in the space of their first part's node; only geometry's
/// own highlights are left to the photometric fiducials; light that grows or fades on a mirrored layer where it is
/// is seen by same_pixels but has no place.

#include <span>

#include "layers/layer.h"
#include "layers/state.h"

namespace talisman::layers {

/// The state of a shade layer from that of its base: the same surface, seen by the same camera.
LayerState shade_state(const LayerState& base, const Layer& shade);

/// What another frame of the same set has captured: by light, and by layer id.
struct KnownInfluences {
  std::span<const LightState> lights;
  std::span<const LayerState> states;
};

/// Fills world_from_influence, world_from_receiver and traces of those states whose layers hold a term that
/// needs them, from the characteristic points of all layers. `states` by layer id. A shadow layer keeps all
/// lights of its base: its alpha is the share that one light has in all of them. Nothing is done or allocated
/// for other layers. A shadow whose light, caster and receiver are where they were in `known` is taken from there: it is
/// the same to the last bit. Cost: O(traced points), of shadows of what moved.
void capture_influences(const SceneFrame& frame, const LayerSet& set, std::span<LayerState> states,
                        const KnownInfluences& known = {});

}  // namespace talisman::layers
