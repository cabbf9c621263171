// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From a scene and its layers to a pipeline that can be stepped.

#include "layers/layer.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Makes the bounds of the layers, equipped for what the settings follow. The scene must outlive the pipeline;
/// the layers (of layers::factor, without defect) become its own. Cost: once per run; reads the vertices of
/// every layer, and the triangles and textures of those on which the light can change.
Pipeline make_pipeline(const layers::Scene& scene, layers::LayerSet layers, const Settings& settings);
Pipeline make_pipeline(layers::Scene&& scene, layers::LayerSet layers, const Settings& settings) = delete;

}  // namespace talisman::sequences
