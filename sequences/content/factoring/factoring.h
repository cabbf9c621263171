// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Layers that nobody wrote: from the parts of a scene and how they move on the display to layers and their order
/// [LS97 2.1].
///
///   node       a layer for each moving node, or for each top-level node where nothing moves
///   velocity   parts that move alike on the display and lie together are one layer (grouping.h), in the order in which
///              they were seen (seen_order.h). What comes out is planned, as are one layer per node and one for all, and
///              the cheapest is taken: no proposal costs more than either.
///   motion     parts whose relative transforms stay constant over the sequence are one layer, wherever they lie and whatever
///              the tree of nodes says (motion_groups.h): what a plan of shared buffers would draw together [F96 3.1.1]
///   amortised  a layer for each part, that share sprites while it runs (sequences/pipeline/regrouping/regroup.h)
///
/// Another way is a value of FactoringWay, its word in factoring_keys.cpp, and a function from Pieces to groups in
/// `factored`.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sequences/content/factoring/grouping.h"
#include "sequences/content/factoring/seen_order.h"

namespace talisman::sequences {

enum class FactoringWay { Node, Velocity, Motion, Amortised };

inline constexpr int kMostLayersByDefault = 40;
inline constexpr int kMostLayers = 1000;

struct AutoLayers {
  FactoringWay way = FactoringWay::Velocity;
  std::optional<int> max{};  ///< 1 … kMostLayers; empty: kMostLayersByDefault; Motion, Amortised: kMostLayers
  int limit() const { return max.value_or(joins_to_limit() ? kMostLayersByDefault : kMostLayers); }
  /// Are layers joined until there are no more? Else it is for what moves alone to say how many there are.
  bool joins_to_limit() const { return way == FactoringWay::Node || way == FactoringWay::Velocity; }
  bool operator==(const AutoLayers&) const = default;
};

/// Beyond this many pieces nothing is factored by motion: the nodes are. Memory grows with the square.
inline constexpr std::size_t kMostFactoredPieces = 1024;

/// What is to be factored.
struct Unfactored {
  const layers::Scene& scene;
  std::vector<layers::LayerSpec> kept;   ///< layers that are there already: they take their parts first
  std::vector<layers::LayerSpec> nodes;  ///< what "node" is; empty: layers::default_layer_specs
  Settings settings;                     ///< under which it is planned
  std::function<void(const std::string&)> begins{};  ///< hears what is done next; empty: nobody
};

struct Factoring {
  std::string how;  ///< "velocity", "node", "one", "motion", "amortised": of which the layers are
  std::vector<layers::LayerSpec> specs;  ///< those that were kept first
  layers::LayerSet set;                  ///< what layers::factor makes of them
  std::vector<std::vector<int>> pieces;  ///< by spec: what each has
  std::vector<SeenPair> order;
  PlannedFactoring plan;
  std::vector<SpecPair> asked;  ///< of which pairs the bounds knew no order
  bool has_background = false;  ///< what lies behind all else (backdrops.h) is in the background
  std::vector<SeenPair> over;   ///< layers that the background is drawn behind, though it hides some of them

  std::vector<SpecPair> pairs() const;
};

/// "layer 'ship' is drawn over 'land', which hides it at 0.4 % of the pixels that both were seen at": of each pair that the
/// order shows wrongly somewhere, and of what stands before the background where that is more than kHidden.
std::vector<std::string> hidden_in_words(const Factoring& factoring);

/// Every layer that was looked at, and what was found on the way.
struct FactoringStudy {
  Pieces pieces;
  std::vector<int> instants;  ///< frames in which motion and depth were looked at
  Factoring chosen;
  std::vector<Factoring>
      others;  ///< the rest of "velocity", "node", "one"; those with too many layers are left out
  /// Pairs of chosen layers, by index of their specs, that it would be the least bad to join, the best first.
  std::vector<SpecPair> nearest_joins;
};

/// The pairs that are listed at most.
inline constexpr std::size_t kNearestJoins = 8;

FactoringStudy study(const Unfactored& scene, const AutoLayers& options);

}  // namespace talisman::sequences
