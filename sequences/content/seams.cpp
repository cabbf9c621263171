// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/seams.h"

#include <algorithm>

namespace talisman::sequences {

void add_seams(layers::Scene& scene, const layers::SeamOptions& options,
               std::vector<layers::LayerSpec>& specs) {
  const layers::LayerSet set = layers::factor(scene, specs);
  if (!set.defect.empty()) return;  // which is said by whoever factors it for good
  for (layers::SeamPiece& piece : layers::seam_pieces(scene, set, options)) {
    const std::string& name = set.layers[static_cast<std::size_t>(piece.layer)].name;
    const auto spec =
        std::find_if(specs.begin(), specs.end(), [&](const layers::LayerSpec& s) { return s.name == name; });
    spec->part_globs.push_back(piece.part.name);
    piece.part.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(piece.mesh));
    scene.parts.push_back(std::move(piece.part));
  }
}

layers::SeamOptions seam_options(const Sequence& sequence) {
  layers::SeamOptions options;
  options.geometric_px = sequence.content.geometric_px.value_or(sequence.regulator.thresholds.geometric_px);
  options.fps = sequence.fps;
  options.frames = sequence.frames;
  options.display_px = sequence.content.display_px.value_or(sequence.display_px);
  return options;
}

}  // namespace talisman::sequences
