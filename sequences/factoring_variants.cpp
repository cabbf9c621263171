// SPDX-License-Identifier: Apache-2.0
#include "sequences/factoring_variants.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using layers::Layer;

/// The layer of this name; names are unique, and those of surfaces are the same in every variant.
int id_of(const layers::LayerSet& set, const std::string& name) {
  const auto found = std::find_if(set.layers.begin(), set.layers.end(),
                                  [&](const Layer& layer) { return layer.name == name; });
  TALISMAN_CHECK(found != set.layers.end());
  return found->id;
}

bool is_animated(const layers::Keys<double>& gain) {
  return std::any_of(gain.values.begin(), gain.values.end(),
                     [&](double value) { return value != gain.values.front(); });
}

/// What the material says, and what the compositor is told, of a layer's two textures.
bool is_blended_otherwise(const layers::Scene& scene, const Layer& layer) {
  if (layer.gain.values.empty()) return false;
  if (is_animated(layer.gain)) return true;
  const bool second = layer.kind == layers::LayerKind::Texture;
  return std::any_of(layer.parts.begin(), layer.parts.end(), [&](int part) {
    const int material = scene.parts[part].material;
    if (material < 0 || scene.materials[material].texture2 < 0) return false;
    const layers::vec2 blend = scene.materials[material].texture_blend;
    return layer.gain.values.front() != static_cast<double>(second ? blend.y : blend.x);
  });
}

}  // namespace

bool is_factored(const Sequence& sequence) {
  const auto& all = sequence.layers.layers;
  return std::any_of(all.begin(), all.end(), [](const Layer& layer) { return layer.base >= 0; });
}

Sequence unfactored(const Sequence& sequence) {
  Sequence whole = sequence;
  for (layers::LayerSpec& spec : whole.layer_specs) spec.shading = {};
  whole.layers = layers::factor(*whole.scene, whole.layer_specs);
  for (layers::ExplicitPair& pair : whole.explicit_order)
    pair = {id_of(whole.layers, sequence.layers.layers[pair.behind].name),
            id_of(whole.layers, sequence.layers.layers[pair.front].name)};
  return whole;
}

bool blends_over_time(const Sequence& sequence) {
  const auto& all = sequence.layers.layers;
  return std::any_of(all.begin(), all.end(),
                     [&](const Layer& layer) { return is_blended_otherwise(*sequence.scene, layer); });
}

Sequence at_full_resolution(const Sequence& sequence, ShadeResolution shades) {
  Sequence full = sequence;
  for (Layer& layer : full.layers.layers) {
    const double own_scale = layer.preferences.resolution_scale;
    if (layer.base >= 0) layer.preferences = full.layers.layers[layer.base].preferences;
    layer.preferences.resolution_scale = layer.base >= 0 && shades == ShadeResolution::Own ? own_scale : 1;
    layer.preferences.motion_blur = 0;
  }
  return full;
}

Settings without_reuse(const Settings& settings) {
  Settings fresh = settings;
  fresh.regulator.policy = regulator::Policy::Reference;
  return fresh;
}

Settings texel_on_pixel(const Settings& settings) {
  Settings flush = without_reuse(settings);
  flush.placement.min_rotation_gain = 1;
  flush.placement.resolution_scale = 1;
  flush.placement.max_sprite_px = chunker_max_sprite_px();
  flush.compression.reset();
  flush.compositor = Compositor::Talisman;
  return flush;
}

}  // namespace talisman::sequences
