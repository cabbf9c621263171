// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Seams of a sequence (layers/seam.h): what each layer draws beyond the edges that it shares with others becomes parts
/// of its own.

#include <vector>

#include "layers/layer.h"
#include "layers/seam.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Adds the parts to the scene, and to the specs the globs that take them. Layers whose names two specs have get none.
void add_seams(layers::Scene& scene, const layers::SeamOptions& options,
               std::vector<layers::LayerSpec>& specs);

/// What the sequence and the command line say together.
layers::SeamOptions seam_options(const Sequence& sequence);

/// The sequence with the seams that a run with these settings needs, as it would be read for it: how far they reach
/// depends on the threshold, on what layers weigh (`layer_specs`) and on the display. The same scene where it has no seams.
/// Cost: that of layers::seam_pieces, and a copy of the scene.
Sequence with_seams_for(Sequence sequence, const Settings& settings);

}  // namespace talisman::sequences
