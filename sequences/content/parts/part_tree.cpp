// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/parts/part_tree.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "sequences/content/default_view.h"
#include "sequences/content/value_type.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::WorldBounds;

/// By part: the name of the geometry layer that takes it.
std::vector<std::string> layers_of_parts(const Sequence& sequence) {
  std::vector<std::string> names(sequence.scene->parts.size());
  for (const layers::Layer& layer : sequence.layers.layers)
    if (layer.base < 0)
      for (const int part : layer.parts) names[static_cast<std::size_t>(part)] = layer.name;
  return names;
}

std::vector<TextureRow> textures_of(const Sequence& sequence) {
  std::map<std::string, std::string> file_of;
  for (const std::string& file : sequence.content_files)
    file_of.emplace(std::filesystem::path(file).filename().string(),
                    std::filesystem::path(file).lexically_normal().string());
  std::vector<TextureRow> rows;
  for (const layers::Texture& texture : sequence.scene->textures) {
    const auto found = file_of.find(texture.name);
    rows.push_back(
        {texture.name, texture.width, texture.height, found == file_of.end() ? "" : found->second});
  }
  return rows;
}

std::vector<int> textures_of(const layers::Material& material) {
  std::vector<int> textures;
  for (const int texture :
       {material.texture, material.texture2, material.emissive_texture, material.normal_texture})
    if (texture >= 0) textures.push_back(texture);
  return textures;
}

/// By node of the scene: its row in the tree; -1: it has none.
std::vector<int> add_nodes(const layers::Scene& scene, PartTree& tree) {
  const std::size_t count = scene.nodes.size();
  std::vector<bool> shown(count), moves(count);
  for (const layers::Part& part : scene.parts)
    for (int node = part.node; node >= 0 && !shown[node]; node = scene.nodes[node].parent) shown[node] = true;
  for (const layers::Track& track : scene.tracks) moves[track.node] = true;
  std::vector<int> row(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    if (!shown[i]) {
      ++tree.other_nodes;
      continue;
    }
    const int parent = scene.nodes[i].parent;
    row[i] = static_cast<int>(tree.nodes.size());
    tree.nodes.push_back({scene.nodes[i].name, parent < 0 ? 0 : tree.nodes[row[parent]].depth + 1, moves[i]});
  }
  return row;
}

/// Rows of the nodes as one meets them from the top: children follow their parent.
std::vector<int> from_the_top(const PartTree& tree, const std::vector<int>& parents) {
  std::vector<std::vector<int>> children(tree.nodes.size());
  std::vector<int> waiting, order;
  for (std::size_t i = tree.nodes.size(); i-- > 0;)
    (parents[i] < 0 ? waiting : children[parents[i]]).push_back(static_cast<int>(i));
  while (!waiting.empty()) {
    order.push_back(waiting.back());
    waiting.pop_back();
    waiting.insert(waiting.end(), children[order.back()].begin(), children[order.back()].end());
  }
  return order;
}

/// The parent of each row is the last row before it that is one level higher.
void sort_from_the_top(const layers::Scene& scene, const std::vector<int>& row, PartTree& tree) {
  std::vector<int> parents(tree.nodes.size(), -1);
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] >= 0 && scene.nodes[i].parent >= 0) parents[row[i]] = row[scene.nodes[i].parent];
  const std::vector<int> order = from_the_top(tree, parents);
  std::vector<int> place(order.size());
  std::vector<NodeRow> sorted;
  for (const int i : order) {
    place[i] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(tree.nodes[i]));
  }
  tree.nodes = std::move(sorted);
  for (PartRow& part : tree.parts) part.node = part.node < 0 ? -1 : place[part.node];
}

dvec3 rounded(const dvec3& v, double step) { return step > 0 ? glm::round(v / step) * step + 0.0 : v; }

/// Four digits of the whole.
double step_of(const WorldBounds& all) {
  const dvec3 size = all.hi - all.lo;
  const double largest = std::max({size.x, size.y, size.z});
  return largest > 0 ? std::pow(10, std::floor(std::log10(largest)) - 3) : 0;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 2, width), ' ');
  return text;
}

std::string part_line(const PartTree& tree, const PartRow& part, const std::string& indent,
                      std::size_t width) {
  const double step = step_of(tree.bounds);
  const WorldBounds b{rounded(part.bounds.lo, step), rounded(part.bounds.hi, step)};
  std::string text = padded("  " + indent + "'" + part.name + "'", width) +
                     formatted("%8d  ", part.polygons) + padded(size_text(b), 24) +
                     padded(place_text(rounded(0.5 * (b.lo + b.hi), step)), 26) +
                     padded(part.layer.empty() ? "none: not drawn" : part.layer, 18) + part.material;
  for (const int texture : part.textures) text += ", '" + tree.textures[texture].name + "'";
  return text + "\n";
}

std::size_t width_of_names(const PartTree& tree) {
  std::size_t width = 24;
  for (const PartRow& part : tree.parts)
    width = std::max(width, part.name.size() + 8 + 2 * (part.node < 0 ? 0 : tree.nodes[part.node].depth));
  return std::min<std::size_t>(width, 60);
}

std::string texture_lines(const PartTree& tree) {
  std::string text;
  for (const TextureRow& texture : tree.textures)
    text += padded("  " + texture.name, 34) + padded(formatted("%dx%d", texture.width, texture.height), 12) +
            (texture.file.empty() ? "inside the model's file" : texture.file) + "\n";
  return text.empty() ? "" : "\n" + padded("  texture", 34) + padded("texels", 12) + "found\n" + text;
}

}  // namespace

PartTree part_tree(const Sequence& sequence) {
  const layers::Scene& scene = *sequence.scene;
  const layers::SceneFrame frame = scene.at(0);
  const std::vector<std::string> layer_of = layers_of_parts(sequence);
  PartTree tree;
  tree.textures = textures_of(sequence);
  const std::vector<int> row = add_nodes(scene, tree);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const layers::Part& part = scene.parts[i];
    const layers::Material& material = scene.materials[part.material];
    PartRow shown_part{part.name,
                       part.node < 0 ? -1 : row[part.node],
                       scene.meshes[part.mesh].triangle_count(),
                       bounds_of_part(frame, part),
                       layer_of[i],
                       material.name,
                       textures_of(material)};
    tree.bounds.lo = glm::min(tree.bounds.lo, shown_part.bounds.lo);
    tree.bounds.hi = glm::max(tree.bounds.hi, shown_part.bounds.hi);
    tree.parts.push_back(std::move(shown_part));
  }
  sort_from_the_top(scene, row, tree);
  tree.not_drawn = sequence.warnings;
  return tree;
}

std::string size_text(const WorldBounds& bounds) {
  if (bounds.empty()) return "nothing";
  const dvec3 size = bounds.hi - bounds.lo;
  return shown(size.x) + " x " + shown(size.y) + " x " + shown(size.z);
}

std::string place_text(const dvec3& v) {
  return "(" + shown(v.x) + ", " + shown(v.y) + ", " + shown(v.z) + ")";
}

std::string text_of(const PartTree& tree) {
  const std::size_t width = width_of_names(tree);
  std::string text = padded("  node, 'part'", width) + "polygons  " + padded("size, m", 24) +
                     padded("middle, m", 26) + padded("layer", 18) + "material, textures\n";
  const auto add_parts_of = [&](int node, const std::string& indent) {
    for (const PartRow& part : tree.parts)
      if (part.node == node) text += part_line(tree, part, indent, width);
  };
  add_parts_of(-1, "");
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const std::string indent(2 * static_cast<std::size_t>(tree.nodes[i].depth), ' ');
    text += "  " + indent + (tree.nodes[i].name.empty() ? "(no name)" : tree.nodes[i].name) +
            (tree.nodes[i].moves ? "  moves" : "") + "\n";
    add_parts_of(static_cast<int>(i), indent + "  ");
  }
  if (tree.other_nodes > 0)
    text += formatted("  and %d more, with nothing to draw at or below them: joints, cameras, lights\n",
                      tree.other_nodes);
  text += texture_lines(tree);
  if (!tree.not_drawn.empty()) text += "\n  not in the picture\n";
  for (const std::string& what : tree.not_drawn) text += "  " + what + "\n";
  return text;
}

}  // namespace talisman::sequences
