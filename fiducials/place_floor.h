// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Below which error of place can no affine map carry an old sprite to where its layer is now? A bound from below that
/// costs a fraction of a fit and an assessment, so that those are spared where they can only say no.
///
/// With p̂ᵢ, pᵢ the places then and now of the n characteristic points that are surely matched (on the display now, and not
/// far beside it then), and r the part of p that is orthogonal to 1, x̂ and ŷ, in both coordinates:
///
///   Geometric::px ≥ maxᵢ ‖pᵢ - W p̂ᵢ‖ ≥ √(Σ ‖pᵢ - W p̂ᵢ‖² / n) ≥ √(Σ ‖rᵢ‖² / n)
///
/// for every W that is affine or simpler, whatever it was fitted for, and whatever other points were matched: a maximum over more
/// is no smaller. What has run over the surface is added to it and is never negative. Four points or more are needed; with fewer,
/// or where x̂ and ŷ are nearly in line, nothing is said: 0. Rounding is given away.

#include "layers/polyhedron.h"
#include "layers/state.h"

namespace talisman::fiducials {

/// px, ≥ 0. `hull` is that of both states' layer. Cost: some 50 ns for a box.
double affine_floor_px(const layers::LayerState& then, const layers::LayerState& now,
                       const layers::Polyhedron& hull);

/// The same of all points that are matched, places where edges leave the display among them: of what the eye flies
/// over, hardly a corner is matched for certain. Cost: the same, and `matched`, some µs.
double affine_floor_px(const layers::Correspondences& matched);

}  // namespace talisman::fiducials
