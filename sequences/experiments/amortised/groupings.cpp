// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/amortised/groupings.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "layers/glob.h"
#include "sequences/content/factoring/factoring.h"

namespace talisman::sequences {

namespace {

using layers::LayerSpec;

Sequence with_layers(const Sequence& sequence, std::vector<LayerSpec> specs,
                     std::vector<layers::ExplicitPair> order) {
  Sequence made = sequence;
  made.layers = layers::factor(*sequence.scene, specs);
  made.layer_specs = std::move(specs);
  made.explicit_order = std::move(order);
  return made;
}

/// By spec: the layer that was made of it.
std::vector<const layers::Layer*> layers_of_specs(const Sequence& sequence) {
  std::vector<const layers::Layer*> found;
  for (const layers::Layer& layer : sequence.layers.layers)
    if (layer.base < 0) found.push_back(&layer);
  return found;
}

/// Every layer of `behind` behind every one of `front`, by the author's pairs.
std::vector<layers::ExplicitPair> pairs_between(const Sequence& sequence,
                                                const std::map<int, std::vector<int>>& made_of) {
  std::vector<layers::ExplicitPair> pairs;
  for (const layers::ExplicitPair& pair : sequence.explicit_order) {
    const auto behind = made_of.find(pair.behind), front = made_of.find(pair.front);
    if (behind == made_of.end() || front == made_of.end()) continue;
    for (const int b : behind->second)
      for (const int f : front->second)
        if (b != f) pairs.push_back({b, f});
  }
  return pairs;
}

LayerSpec spec_like(const LayerSpec& author, const std::string& name) {
  LayerSpec spec = author;
  spec.name = name;
  spec.part_globs.clear();
  spec.shading = {};
  return spec;
}

bool is_among(const layers::ExplicitPair& pair, const std::vector<layers::ExplicitPair>& pairs) {
  return std::any_of(pairs.begin(), pairs.end(), [&pair](const layers::ExplicitPair& other) {
    return other == pair || other == layers::ExplicitPair{pair.front, pair.behind};
  });
}

/// Adds the order in which parts are seen, where their author has none.
void add_seen_order(const Settings& settings, Sequence& parts) {
  const Factoring found = study({*parts.scene, {}, {}, settings}, {FactoringWay::Amortised}).chosen;
  std::map<std::string, int> id_of;
  for (const layers::Layer& layer : parts.layers.layers) id_of[layer.name] = layer.id;
  const std::vector<layers::ExplicitPair> authored = parts.explicit_order;
  for (const auto& [behind, front] : found.pairs()) {
    const auto b = id_of.find(layers::name_of_glob(found.specs[behind].part_globs.front())),
               f = id_of.find(layers::name_of_glob(found.specs[front].part_globs.front()));
    if (b == id_of.end() || f == id_of.end()) continue;
    const bool same_group = parts.layers.layers[b->second].group == parts.layers.layers[f->second].group;
    if (same_group && !is_among({b->second, f->second}, authored))
      parts.explicit_order.push_back({b->second, f->second});
  }
}

}  // namespace

std::optional<Sequence> one_layer_per_part(const Sequence& sequence, const Settings& settings) {
  std::vector<LayerSpec> specs;
  std::map<std::string, int> spec_of;       // by part
  std::map<int, std::vector<int>> made_of;  // by the author's layer
  const std::vector<const layers::Layer*> authored = layers_of_specs(sequence);
  for (std::size_t i = 0; i < authored.size(); ++i)
    for (const int part : authored[i]->parts) {
      const std::string& name = sequence.scene->parts[part].name;
      const auto [it, is_new] = spec_of.try_emplace(name, static_cast<int>(specs.size()));
      if (!is_new) continue;
      specs.push_back(spec_like(sequence.layer_specs[i], name));
      specs.back().part_globs = {layers::glob_of_name(name)};
      made_of[authored[i]->id].push_back(it->second);
    }
  if (specs.size() > kMostParts) return std::nullopt;
  Sequence parts = with_layers(sequence, std::move(specs), pairs_between(sequence, made_of));
  add_seen_order(settings, parts);
  return parts;
}

Sequence joined_layers(const Sequence& sequence, const std::vector<int>& set_of) {
  std::vector<LayerSpec> specs;
  std::map<int, int> spec_of;               // by set
  std::map<int, std::vector<int>> made_of;  // by layer
  const std::vector<const layers::Layer*> authored = layers_of_specs(sequence);
  for (std::size_t i = 0; i < authored.size(); ++i) {
    const LayerSpec& own = sequence.layer_specs[i];
    const auto [it, is_new] = spec_of.try_emplace(set_of[i], static_cast<int>(specs.size()));
    if (is_new) specs.push_back(spec_like(own, own.name));
    std::vector<std::string>& globs = specs[it->second].part_globs;
    globs.insert(globs.end(), own.part_globs.begin(), own.part_globs.end());
    made_of[authored[i]->id] = {it->second};
  }
  return with_layers(sequence, std::move(specs), pairs_between(sequence, made_of));
}

Sequence one_layer_per_group(const Sequence& sequence) {
  const std::vector<LayerSpec>& specs = sequence.layer_specs;
  std::vector<int> set_of(specs.size());
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto first = std::find_if(specs.begin(), specs.end(), [&](const LayerSpec& other) {
      return other.group == specs[i].group && other.preferences == specs[i].preferences;
    });
    set_of[i] = static_cast<int>(first - specs.begin());
  }
  return joined_layers(sequence, set_of);
}

std::vector<std::vector<int>> partitions(int count) {
  std::vector<std::vector<int>> all = {{}};
  for (int i = 0; i < count; ++i) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& shorter : all) {
      const int sets = shorter.empty() ? 0 : *std::max_element(shorter.begin(), shorter.end()) + 1;
      for (int set = 0; set <= sets; ++set) {
        longer.push_back(shorter);
        longer.back().push_back(set);
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace talisman::sequences
