// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Levels of detail in the plan of a frame.
///
/// `optimise`, of policy budget with a budget of ms: each layer in view is a choice (regulator/lod/solver.h) among
///
///   keep      its old sprite, warped                       t = 0
///   draw      at a level and a resolution (LevelChoice)    t = modelled time on the profile, alone [Fu93 4.2]
///   skip      nothing is shown; only first appearances, with `--first-appearance skip`
///
/// where an old sprite that no warp carries soundly is none: its layer counts as one that appears. Since a frame's time is at
/// most the sum of that of its layers, the budget holds. With `coarsest` a first appearance has no cheaper choice than its
/// cheapest picture; where those of all layers exceed the budget, that is said (LodPlan::fits).
///
///   benefit by error    draw: B + w (e_then - e) + w_s ((1/r_then - 1) - (1/r - 1)), px   B of regulator/budget.h: what the
///                       fiducials say; e level errors, r resolutions, then: of the old sprite. First appearances: the
///                       side of a square as large as the sprite, less e and 1/r - 1; nothing shown: 0
///   … as printed        draw: six factors [Fu93 4.2]; keep: those of its level, times 1 - F / geometric_px
///
/// Shadow maps that a layer in view looks up, and that are out of date, are drawn first as far as the budget affords them
/// beside the cheapest choices; the others stay as they are.

#include <span>
#include <vector>

#include "regulator/budget.h"
#include "regulator/lod/solver.h"
#include "regulator/plan.h"
#include "regulator/shadow_maps.h"

namespace talisman::regulator {

/// All decisions of a frame. `solver`: of the run, which it makes faster; null: a new one.
FramePlan decide_lod(int frame, std::span<const LayerAssessment> assessments, const RegulatorOptions& options,
                     std::span<const MapAssessment> maps, LodSolver* solver);

/// Says in decisions that were made without regard to levels at which level each layer is shown, and adds its error to
/// what is shown.
void say_levels(std::span<const LayerAssessment> assessments, std::vector<LayerDecision>& decisions);

/// Of drawing that, ms on talisman-1996.
double drawing_ms(const LayerCost& cost, const RegulatorOptions& options);

}  // namespace talisman::regulator
