// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far have shadows, highlights and mirrored pictures run over a surface since its sprite was drawn?
///
/// The warp of a shade sprite is that of its receiver: it explains the motion of the surface, not what runs
/// over it. A trace (layers/shade_state.h) has its places in the receiver's own space, then ŝᵢ and now sᵢ, so
/// what the warp does not explain is the path from ŝᵢ to sᵢ on the surface as it lies now:
///
///   M = max over the traces that are on the receiver then or now, and over i, of
///       length on the display of the segment from P(R ŝᵢ) to P(R sᵢ), clipped to the display     [px]
///
/// with R the receiver's matrix and P the projection now. Best 0: at rest, and whenever light, eye, casters
/// and receiver move together. A place that existed in one state only (a caster rose above the light) is
/// counted as if it crossed all of the receiver that is on the display: nothing better is known. A trace that
/// is on the receiver in neither state does not count, nor what happens out of view.

#include "fiducials/fiducials.h"

namespace talisman::fiducials {

/// Cost: nothing without traces; else O(places), some 30 ns each.
ShadeMotion shade_motion(const layers::LayerState& then, const layers::LayerState& now);

/// Is M beyond `limit_px` ≥ 0? Asked of the places one by one, up to the first that says so: mostly of one.
bool shade_runs_beyond(const layers::LayerState& then, const layers::LayerState& now, double limit_px);

std::string_view name(layers::ShadeTrace::Kind kind);  ///< "shadow", "highlight", "reflection"

}  // namespace talisman::fiducials
