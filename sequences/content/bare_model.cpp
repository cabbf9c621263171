// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/bare_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "layers/animation.h"
#include "layers/glob.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/content/own_settings.h"
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

std::vector<layers::LayerSpec> tagged_specs(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  const std::vector<std::string> tag_of = tags_of_nodes(scene, tags);
  std::vector<layers::LayerSpec> specs;
  std::map<std::string, std::size_t> spec_of;
  for (const layers::Part& part : scene.parts) {
    const std::string& layer = tag_of[part.node];
    if (layer.empty()) continue;
    const auto [entry, is_new] = spec_of.emplace(layer, specs.size());
    if (is_new) specs.push_back({layer, {}, layers::OrderGroup::Normal, {}});
    specs[entry->second].part_globs.push_back(layers::glob_of_name(part.name));
  }
  return specs;
}

std::vector<layers::LayerSpec> specs_of_model(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  std::vector<layers::LayerSpec> specs = tagged_specs(scene, tags);
  std::set<std::string> used, tagged_parts;
  for (const layers::LayerSpec& spec : specs) {
    used.insert(spec.name);
    tagged_parts.insert(spec.part_globs.begin(), spec.part_globs.end());
  }
  for (layers::LayerSpec& spec : layers::default_layer_specs(scene)) {
    std::erase_if(spec.part_globs, [&](const std::string& glob) { return tagged_parts.contains(glob); });
    spec.name = unused_name(used, spec.name);
    if (!spec.part_globs.empty()) specs.push_back(std::move(spec));
  }
  return specs;
}

namespace {

/// Nodes that move parts by themselves, and parts that deform.
std::size_t moving_bodies(const layers::Scene& scene) {
  const std::vector<int> carriers = layers::moving_carriers(scene);
  std::set<int> rigid;
  std::size_t deforming = 0;
  for (const layers::Part& part : scene.parts) {
    if (layers::deforms(scene, part))
      ++deforming;
    else if (carriers[part.node] >= 0)
      rigid.insert(carriers[part.node]);
  }
  return rigid.size() + deforming;
}

/// The scene without what its textures show, of which a plan asks nothing.
layers::Scene without_texels(layers::Scene& scene) {
  std::vector<std::vector<std::uint8_t>> texels;
  for (layers::Texture& texture : scene.textures) texels.push_back(std::exchange(texture.rgba, {}));
  layers::Scene copy = scene;
  for (std::size_t i = 0; i < texels.size(); ++i) scene.textures[i].rgba = std::move(texels[i]);
  return copy;
}

void factor_by_motion(BareModel& bare) {
  layers::Scene shown = without_texels(bare.model.scene);
  std::vector<layers::LayerSpec> kept = tagged_specs(shown, bare.model.layer_tags);
  std::vector<layers::LayerSpec> nodes = layers::default_layer_specs(shown);
  const std::size_t tagged = kept.size();
  add_model_view(shown, kept, bare.view);
  const std::size_t all_kept = kept.size();
  Sequence as_shown;
  as_shown.fps = bare.fps;
  as_shown.frames = bare.frames;
  Factoring found =
      study({shown, std::move(kept), std::move(nodes), own_settings(as_shown)}, AutoLayers{}).chosen;
  bare.specs.assign(found.specs.begin(), found.specs.begin() + static_cast<std::ptrdiff_t>(tagged));
  bare.specs.insert(bare.specs.end(), found.specs.begin() + static_cast<std::ptrdiff_t>(all_kept),
                    found.specs.end());
  const auto place_now = [&](std::size_t spec) {
    return spec < tagged ? spec : spec < all_kept ? bare.specs.size() : spec - (all_kept - tagged);
  };
  for (const auto& [behind, front] : found.pairs())
    bare.order.emplace_back(place_now(behind), place_now(front));
}

}  // namespace

BareModel read_bare_model(const std::string& path, const ContentOptions& options) {
  BareModel bare;
  bare.model = import_model(path, import_limits(), options.assets);
  bare.view = {options.turntable_s.value_or(kTurntable_s), options.stage, options.exposure_lx.value_or(1)};
  bare.frames = frames_of_model(bare.model.scene, bare.view.turn_s, bare.fps);
  if (options.exposure_lx) expose(bare.model, *options.exposure_lx);
  if (moving_bodies(bare.model.scene) > 1)
    factor_by_motion(bare);
  else
    bare.specs = specs_of_model(bare.model.scene, bare.model.layer_tags);
  return bare;
}

}  // namespace talisman::sequences
