// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/cut_layers.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "layers/glob.h"
#include "layers/lod/levels.h"
#include "layers/mesh_clusters.h"
#include "layers/mesh_subset.h"
#include "layers/shading.h"
#include "sequences/content/levels.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::Mesh;

bool can_be_cut(const Sequence& sequence, const Layer& layer, int pieces) {
  if (layer.kind != layers::LayerKind::Geometry || layer.parts.size() != 1) return false;
  const layers::Part& part = sequence.scene->parts[layer.parts[0]];
  if (part.is_seam || layers::deforms(*sequence.scene, part)) return false;
  bool has_shades = false;
  for (const Layer& other : sequence.layers.layers) has_shades = has_shades || other.base == layer.id;
  return !has_shades && sequence.scene->meshes[part.mesh].triangle_count() >= 16 * pieces;
}

/// Three indices for each of the triangles.
std::vector<std::uint32_t> indices_of(const Mesh& mesh, const std::vector<int>& triangles) {
  std::vector<std::uint32_t> indices;
  for (const int t : triangles)
    indices.insert(indices.end(), mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
  return indices;
}

void cut_layer(const Layer& layer, int pieces, layers::Scene& scene, Sequence& cut) {
  const layers::Part part = scene.parts[layer.parts[0]];
  const Mesh whole = scene.meshes[part.mesh];
  const auto groups = layers::triangle_groups(whole, (whole.triangle_count() + pieces - 1) / pieces);
  const auto spec = std::find_if(cut.layer_specs.begin(), cut.layer_specs.end(),
                                 [&](const layers::LayerSpec& s) { return s.name == layer.name; });
  if (spec == cut.layer_specs.end() || groups.size() < 2) return;
  layers::LayerSpec wishes = *spec;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const int mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(layers::with_triangles(whole, indices_of(whole, groups[k])));
    if (k == 0) {
      scene.parts[layer.parts[0]].mesh = mesh;
      continue;
    }
    layers::Part piece = part;
    const std::string which = ", piece " + std::to_string(k + 1);
    piece.mesh = mesh;
    piece.name += which;
    wishes.name = layer.name + which;
    wishes.part_globs = {layers::glob_of_name(piece.name)};
    scene.parts.push_back(std::move(piece));
    cut.layer_specs.push_back(wishes);
  }
}

}  // namespace

Sequence with_cut_layers(const Sequence& sequence, int pieces) {
  if (pieces < 2) return sequence;
  Sequence cut = sequence;
  layers::Scene scene = layers::without_levels(*sequence.scene);
  for (layers::LayerSpec& spec : cut.layer_specs)  // whose globs would take the pieces, too
    for (const Layer& layer : sequence.layers.layers) {
      if (layer.name != spec.name || !can_be_cut(sequence, layer, pieces)) continue;
      spec.part_globs = {layers::glob_of_name(scene.parts[layer.parts[0]].name)};
    }
  for (const Layer& layer : sequence.layers.layers)
    if (can_be_cut(sequence, layer, pieces)) cut_layer(layer, pieces, scene, cut);
  cut.layers = layers::factor(scene, cut.layer_specs);
  cut.scene = std::make_shared<const layers::Scene>(std::move(scene));
  cut.seam = Seam::Auto;
  if (sequence.scene->levels) add_levels(cut);
  return cut;
}

}  // namespace talisman::sequences
