// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The levels of detail of a run (layers/lod/levels.h): what each layer would cost at each of them in this frame, and how far
/// off it would be (level_error_px, at the nearest depth of its bounds, at the corner of the display). A layer of several
/// parts is drawn without those that its sprite does not show, and with Optimise each part has its own level
/// (layers/lod/member_levels.h): what is called the layer's level is then the rung of allowed errors.
///
/// A level changes only with a render. What is judged of an old sprite is its warp's error and what a render would take
/// off the error of its level; what is said of a shown sprite is the warp's error and all of its level's: the bound of how far
/// it is from the mesh itself. Shadow maps, mirrored pictures and `reference` are drawn at the finest level always.

#include <vector>

#include "regulator/lod/solver.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Fills in the levels of all layers in view, and with a selector that looks at one layer at a time also which of them would
/// be drawn.
void assess_levels(const Pipeline& pipeline, PipelineState& state, int frame,
                   const regulator::RegulatorOptions& options,
                   std::vector<regulator::LayerAssessment>& assessments);

/// The solver of the run, or null where none is needed.
regulator::LodSolver* solver_of(PipelineState& state, const regulator::RegulatorOptions& options);

/// A layer is drawn as decided: its sprite is placed at the resolution that was chosen with the level.
void place_at_level(const Pipeline& pipeline, PipelineState& state, int frame,
                    const regulator::LayerDecision& decision);

/// The layer as its sprite holds it.
layers::Layer drawn_layer(const Pipeline& pipeline, const layers::Layer& layer, const LayerMemory& memory);

/// `cost` of a layer at its finest level becomes that of what `memory` says is drawn.
void lower_cost(const Pipeline& pipeline, const layers::Layer& layer, const LayerMemory& memory,
                regulator::LayerCost& cost);

/// After a frame is planned: what Feedback learns of it.
void note_drawing_time(const Pipeline& pipeline, PipelineState& state, const FrameReport& report);

/// Modelled time of what a frame draws, ms, as planned: texels filled FrameReport::depth_complexity times.
double planned_drawing_ms(const FrameReport& report);

}  // namespace talisman::sequences
