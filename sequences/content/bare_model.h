// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is made of a model about which nothing else is said: its layers, and how long and how it is shown.

#include <string>
#include <vector>

#include "layers/layer.h"
#include "sequences/content/default_view.h"
#include "sequences/content/factoring/planned_factoring.h"
#include "sequences/content/sequence.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {

/// Layers that the model's author named.
std::vector<layers::LayerSpec> tagged_specs(const layers::Scene& scene, const std::vector<LayerTag>& tags);

/// Those, then what the moving and top-level nodes give for the rest.
std::vector<layers::LayerSpec> specs_of_model(const layers::Scene& scene, const std::vector<LayerTag>& tags);

struct BareModel {
  ImportedModel model;  ///< as the file is, but for the exposure that was asked for
  /// Of the model alone: where more than one node moves found by how they do (factoring/factoring.h), else by node.
  std::vector<layers::LayerSpec> specs;
  std::vector<SpecPair>
      order;  ///< by index of `specs`; one beyond them is the ground that add_model_view adds
  double fps = 24;
  int frames = 1;  ///< as many as its animation lasts, at most 20 s, else one turn of the camera
  ModelView view;  ///< what it gets to be seen
};

/// Throws InputError.
BareModel read_bare_model(const std::string& path, const ContentOptions& options);

}  // namespace talisman::sequences
