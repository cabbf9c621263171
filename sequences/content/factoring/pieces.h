// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What can be told apart where a scene is factored: the parts of one name, which globs take together.

#include <span>
#include <vector>

#include "layers/layer.h"

namespace talisman::sequences {

struct Pieces {
  /// A layer each: first those that may be joined, then those of the layers that stay as they are.
  std::vector<layers::Layer> layers;
  std::size_t free = 0;  ///< how many may be joined

  bool is_free(int piece) const { return static_cast<std::size_t>(piece) < free; }
};

/// Of the parts that no layer of `kept` takes a piece for each name; then one for each of `kept`.
Pieces pieces_of(const layers::Scene& scene, std::span<const layers::LayerSpec> kept);

/// The same with a piece for each moving or top-level node: of `nodes`, where there are any, else as layers::default_layer_specs
/// has them without the nodes behind the last one of a free part, which a view added.
Pieces node_pieces_of(const layers::Scene& scene, std::span<const layers::LayerSpec> kept,
                      const std::vector<layers::LayerSpec>& nodes = {});

/// Groups of the free pieces: those that follow one moving node and touch each other are a body, the others are alone.
std::vector<std::vector<int>> bodies_of(const layers::Scene& scene, const Pieces& pieces);

/// Layers that have the parts of these groups of free pieces, in their order. A group that is one of `nodes` has its name, one of
/// several pieces is named after what its parts begin with or after its largest; with parts that lie apart, or that nothing carries, each has a polyhedron of its own: one around
/// them all would know nothing of the parallax between them. No name of `kept` is used again.
std::vector<layers::LayerSpec> specs_of_groups(const layers::Scene& scene,
                                               std::span<const layers::LayerSpec> kept, const Pieces& pieces,
                                               const std::vector<std::vector<int>>& groups,
                                               const Pieces& nodes = {});

}  // namespace talisman::sequences
