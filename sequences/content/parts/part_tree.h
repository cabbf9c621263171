// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is in a scene, as a tree of its nodes: what to write into the `parts` of a layer, how large and where each
/// part is, and where its textures came from. All places are those of the first frame, in metres.

#include <string>
#include <vector>

#include "layers/layer.h"
#include "sequences/content/sequence.h"

namespace talisman::sequences {

struct PartRow {
  std::string name;  ///< as globs see it
  int node = -1;     ///< index into PartTree::nodes
  int polygons = 0;
  layers::WorldBounds bounds;
  std::string layer;  ///< that takes it; empty: none does, and it is not drawn
  std::string material;
  std::vector<int> textures;  ///< indices into PartTree::textures
};

/// A node with a part at it or below it.
struct NodeRow {
  std::string name;
  int depth = 0;
  bool moves = false;  ///< by a track of its own
};

struct TextureRow {
  std::string name;
  int width = 0, height = 0;
  std::string file;  ///< path; empty: it is inside the model's file
};

struct PartTree {
  std::vector<NodeRow> nodes;  ///< each before its children
  std::vector<PartRow> parts;
  std::vector<TextureRow> textures;
  layers::WorldBounds bounds;
  int other_nodes = 0;                 ///< joints, cameras, lights: nothing to draw at or below them
  std::vector<std::string> not_drawn;  ///< what the picture lacks of the content: missing textures, lines, …
};

PartTree part_tree(const Sequence& sequence);

/// The tree, a line per node and part, then textures and what is not drawn.
std::string text_of(const PartTree& tree);

/// "1.2 x 0.5 x 3": the sides of a box.
std::string size_text(const layers::WorldBounds& bounds);
/// "(1.2, 0.5, 3)".
std::string place_text(const layers::dvec3& place);

}  // namespace talisman::sequences
