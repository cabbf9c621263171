// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which order are the sprites of one frame composited, and which layers share one? The data; how it comes
/// about is in sequences/pipeline/aggregates.h.

#include <map>
#include <string>
#include <vector>

#include "layers/visibility.h"
#include "layers/visibility_expression.h"

namespace talisman::sequences {

/// What happens to layers that occlude each other in a cycle.
enum class Cycles {
  Merge,  ///< drawn into one sprite while the cycle lasts: always right
  Keep,   ///< each keeps its sprite, farthest point first: costs no rendering, and is wrong somewhere
};

/// Which operators the compositor has: the profile of its hardware.
enum class Compositor {
  Talisman,  ///< `over` alone, one band buffer: cycles are merged (or kept, and wrong)
  Extended,  ///< also out and plus, and two image registers: most cycles need no merging
};

/// An aggregate that exists in this frame.
struct Merger {
  int layer = -1;  ///< its id
  /// "a, b occlude each other", "a, b, c occlude each other in a cycle", "cheaper together: …"
  std::string why;
};

/// Layers that have no order but a compositing expression, and keep their own sprites.
struct ResolvedCycle {
  std::vector<int> layers;  ///< ascending
  layers::CompositeExpression expression;
};

/// What the expressions of a frame ask of the compositor.
struct ResolvedCounters {
  int components = 0;  ///< expressions, each of a component that `over` alone would have merged
  int layers = 0;      ///< that have own sprites for it
  int registers = 0;   ///< images that one of them keeps at once, at most
  int operators = 0;   ///< that are evaluated, each over an image; laying the result over the frame is one
  int reads = 0;       ///< of sprites, all together; `over` alone reads each once
  bool operator==(const ResolvedCounters&) const = default;
};

struct FrameOrder {
  std::vector<int> back_to_front;  ///< ids of all layers with a sprite of their own: in view and not merged
  std::vector<int> merged_into;    ///< by layer id: the aggregate that draws it in this frame, -1: none
  std::vector<int> split_from;     ///< by layer id: the aggregate that drew it until the last frame, -1: none
  std::map<int, std::string> why_split;  ///< by id of such a layer, where it was the regulator's choice
  std::vector<Merger> mergers;           ///< in the order in which they are composited
  /// In the order in which they are composited. Their layers are side by side in back_to_front.
  std::vector<ResolvedCycle> resolved;
  bool sorted = false;                  ///< false: the groups alone gave the order, and nothing was computed
  layers::VisibilityCounters counters;  ///< merged: only what shares a sprite, or would if cycles were merged
  int merged_parts = 0;                 ///< of all aggregates together
  double sort_ms = 0;                   ///< wall time, bounds and aggregates included

  /// Is `layer` an author's layer that no aggregate draws, or an aggregate of this frame?
  bool has_own_sprite(int layer, bool is_aggregate) const;
  /// The aggregate `layer`, or null if it does not exist in this frame.
  const Merger* merger(int layer) const;
  /// The expression that shows `layer`, or null: it is composited with `over`.
  const ResolvedCycle* resolved_with(int layer) const;
  ResolvedCounters resolved_counters() const;
};

}  // namespace talisman::sequences
