// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/bare_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sequences/content/value_type.h"

namespace talisman::sequences {

namespace {

constexpr double kMaxModel_s = 20;   // longer animations are cut
constexpr double kTurntable_s = 20;  // one turn around a bare model

/// The layer tag of the nearest tagged node above (or at) each node; empty: none.
std::vector<std::string> tags_of_nodes(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  std::vector<std::string> tag_of(scene.nodes.size());
  for (const LayerTag& tag : tags) tag_of[tag.node] = tag.layer;
  for (std::size_t i = 0; i < tag_of.size(); ++i)
    if (tag_of[i].empty() && scene.nodes[i].parent >= 0) tag_of[i] = tag_of[scene.nodes[i].parent];
  return tag_of;
}

/// The lights of the file as they are under another exposure.
void expose(ImportedModel& model, double exposure_lx) {
  for (layers::Light& light : model.scene.lights)
    light.color *= static_cast<float>(model.exposure_lx / exposure_lx);
  if (!model.scene.lights.empty())
    model.notes.push_back("the exposure that was asked for, " + shown(exposure_lx) +
                          " lx, takes the place of the file's");
}

/// As many as the animation lasts, else one turn of the camera.
int frames_of_model(const layers::Scene& scene, double turntable_s, double fps) {
  const double duration = std::min(scene.duration_s(), kMaxModel_s);
  const double frames = std::round((duration > 0 ? duration : turntable_s) * fps);
  return static_cast<int>(std::clamp<double>(frames, 1, kLongestRun_frames));
}

}  // namespace

std::vector<layers::LayerSpec> specs_of_model(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  const std::vector<std::string> tag_of = tags_of_nodes(scene, tags);
  std::vector<layers::LayerSpec> specs;
  std::map<std::string, std::size_t> spec_of;
  std::vector<std::string> tagged_parts;
  for (const layers::Part& part : scene.parts) {
    const std::string& layer = tag_of[part.node];
    if (layer.empty()) continue;
    const auto [entry, is_new] = spec_of.emplace(layer, specs.size());
    if (is_new) specs.push_back({layer, {}, layers::OrderGroup::Normal, {}});
    std::string glob = part.name;
    std::replace(glob.begin(), glob.end(), '*', '?');
    specs[entry->second].part_globs.push_back(glob);
    tagged_parts.push_back(glob);
  }
  for (layers::LayerSpec& spec : layers::default_layer_specs(scene)) {
    std::erase_if(spec.part_globs, [&](const std::string& glob) {
      return std::find(tagged_parts.begin(), tagged_parts.end(), glob) != tagged_parts.end();
    });
    while (spec_of.count(spec.name)) spec.name += "'";
    if (!spec.part_globs.empty()) specs.push_back(std::move(spec));
  }
  return specs;
}

BareModel read_bare_model(const std::string& path, const ContentOptions& options) {
  BareModel bare;
  bare.model = import_model(path, {}, options.assets);
  bare.view = {options.turntable_s.value_or(kTurntable_s), options.stage, options.exposure_lx.value_or(1)};
  bare.frames = frames_of_model(bare.model.scene, bare.view.turn_s, bare.fps);
  if (options.exposure_lx) expose(bare.model, *options.exposure_lx);
  bare.specs = specs_of_model(bare.model.scene, bare.model.layer_tags);
  return bare;
}

}  // namespace talisman::sequences
