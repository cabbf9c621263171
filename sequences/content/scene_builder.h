// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From what a sequence file says (scene_recipe.h) to a scene: opens models and pictures and puts everything
/// where it belongs.

#include <map>
#include <string>
#include <vector>

#include "layers/layer.h"
#include "sequences/content/scene_recipe.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {

struct ModelCamera {
  std::string model;  ///< the name of its instance
  layers::Camera camera;
};

struct BuiltScene {
  layers::Scene scene;
  std::vector<LayerTag> layer_tags;
  std::vector<std::string> warnings;
  std::vector<std::string> notes = {};          ///< what was decided where the file leaves it open
  std::vector<std::string> files = {};          ///< that were opened for it: Sequence::content_files
  std::map<std::string, int> carriers = {};     ///< the node of each shape and image, by its name
  std::vector<ModelCamera> model_cameras = {};  ///< of which the recipe may choose one
  double last_s = 0;           ///< time of the sequence's last frame: so much of traces is read
  layers::CellSet cells = {};  ///< without a defect
};

/// The node, with its motion, that carries something; throws InputError for a carrier that is not there and a trace that
/// is none.
int add_motion(BuiltScene& built, const std::string& name, const Motion& motion);

/// Opens the assets. Where the recipe has no camera or no light, the scene gets the defaults of
/// default_view.h; cameras and lights inside its models are used where it says so. Throws InputError for an asset that
/// cannot be read, a name that is given twice and a carrier that is not there.
BuiltScene build_scene(const SceneRecipe& recipe);

}  // namespace talisman::sequences
