// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers have their light and their faces followed, and what that says of an old sprite: the
/// photometric and the facing fiducials as `step` uses them. A layer on which the light cannot change costs
/// nothing.

#include <vector>

#include "sequences/step.h"

namespace talisman::sequences {

/// Equips the bounds (one per layer) for what these options follow: a surface for each layer on which the
/// light can change, the frames of the bodies where turned faces are regulated. Cost: once per run; reads
/// the triangles and textures of the layers concerned; bounds that are equipped already stay as they are.
void follow_light_and_faces(const layers::Scene& scene, const layers::LayerSet& layers,
                            const regulator::RegulatorOptions& options,
                            std::vector<layers::LayerBound>& bounds);

/// Fills in Report::photometric, with the names of the lights, and Report::turned.
void assess_light_and_faces(const Pipeline& pipeline, const layers::LayerState& then,
                            const layers::LayerState& now, fiducials::Report& report);

}  // namespace talisman::sequences
