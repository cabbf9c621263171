// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/cut_layers.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "layers/glob.h"
#include "layers/mesh_clusters.h"
#include "layers/shading.h"

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

/// Its vertices stay all: which are used is for the triangles to say.
Mesh with_triangles(const Mesh& mesh, const std::vector<int>& triangles) {
  Mesh piece = mesh;
  piece.indices.clear();
  for (const int t : triangles)
    piece.indices.insert(piece.indices.end(), mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
  return piece;
}

/// The same mesh without the vertices that no triangle names.
template <typename T>
void keep_used(const std::vector<int>& used, std::vector<T>& values) {
  if (values.empty()) return;
  std::vector<T> kept;
  kept.reserve(used.size());
  for (const int v : used) kept.push_back(values[v]);
  values = std::move(kept);
}

Mesh compacted(Mesh mesh) {
  std::vector<int> place(mesh.positions.size(), -1), used;
  for (std::uint32_t& index : mesh.indices) {
    if (place[index] < 0) {
      place[index] = static_cast<int>(used.size());
      used.push_back(static_cast<int>(index));
    }
    index = static_cast<std::uint32_t>(place[index]);
  }
  keep_used(used, mesh.positions);
  keep_used(used, mesh.normals);
  keep_used(used, mesh.uvs);
  keep_used(used, mesh.emissive_uvs);
  keep_used(used, mesh.normal_uvs);
  keep_used(used, mesh.tangents);
  keep_used(used, mesh.colors);
  keep_used(used, mesh.alphas);
  return mesh;
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
    scene.meshes.push_back(compacted(with_triangles(whole, groups[k])));
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
  layers::Scene scene = *sequence.scene;
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
  return cut;
}

}  // namespace talisman::sequences
