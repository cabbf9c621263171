// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/seams.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "layers/check.h"
#include "layers/glob.h"
#include "layers/lod/levels.h"
#include "sequences/content/levels.h"

namespace talisman::sequences {

void add_seams(layers::Scene& scene, const layers::SeamOptions& options,
               std::vector<layers::LayerSpec>& specs) {
  const layers::LayerSet set = layers::factor(scene, specs);
  if (!set.defect.empty()) return;  // which is said by whoever factors it for good
  for (layers::SeamPiece& piece : layers::seam_pieces(scene, set, options)) {
    const std::string& name = set.layers[static_cast<std::size_t>(piece.layer)].name;
    const auto spec =
        std::find_if(specs.begin(), specs.end(), [&](const layers::LayerSpec& s) { return s.name == name; });
    spec->part_globs.push_back(layers::glob_of_name(piece.part.name));
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

namespace {

/// Undoes add_seams: its parts and meshes are the last ones.
void remove_seams(layers::Scene& scene, std::vector<layers::LayerSpec>& specs) {
  std::set<std::string> seams;
  while (!scene.parts.empty() && scene.parts.back().is_seam) {
    TALISMAN_CHECK_EQ(scene.parts.back().mesh, static_cast<int>(scene.meshes.size()) - 1);
    seams.insert(layers::glob_of_name(scene.parts.back().name));
    scene.parts.pop_back();
    scene.meshes.pop_back();
  }
  for (layers::LayerSpec& spec : specs)
    std::erase_if(spec.part_globs, [&](const std::string& glob) { return seams.contains(glob); });
}

}  // namespace

Sequence with_seams_for(Sequence sequence, const Settings& settings) {
  if (sequence.content.seam.value_or(sequence.seam) != Seam::Auto) return sequence;
  sequence.content.geometric_px = settings.regulator.thresholds.geometric_px;
  sequence.content.display_px = settings.view.display_px;
  const bool has_levels = sequence.scene->levels != nullptr;
  layers::Scene scene = layers::without_levels(*sequence.scene);
  remove_seams(scene, sequence.layer_specs);
  add_seams(scene, seam_options(sequence), sequence.layer_specs);
  sequence.layers = layers::factor(scene, sequence.layer_specs);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  if (has_levels) add_levels(sequence);
  return sequence;
}

}  // namespace talisman::sequences
