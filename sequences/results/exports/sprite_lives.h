// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From decisions, frame by frame, to the lives of sprites: how long was each one shown, and why was it drawn?
///
/// A life begins with a decision to draw, or with the first one that shows a sprite from before (the range of the run
/// begins there, or the layer was out of view); it ends with the next decision to draw, with a drop, or where the layer
/// has no more decisions. The lives of one layer follow each other and never overlap.

#include <functional>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

struct SpriteLife {
  std::string layer;
  nlohmann::ordered_json first;  ///< the decision with which it begins, a line of decisions.jsonl
  bool drawn = false;            ///< by that decision; false: the sprite is from before
  int begin = 0, end = 0;        ///< frames; shown in begin … end - 1
  double max_geometric_px = 0;   ///< of what was displayed
  std::string ended;             ///< the reason of the decision behind it; empty: there was none
};

class SpriteLives {
 public:
  explicit SpriteLives(std::function<void(const SpriteLife&)> show) : show_(std::move(show)) {}
  /// Takes the lines of decisions.jsonl in their order.
  void add(const nlohmann::ordered_json& decision);
  /// Ends all that go on.
  void finish();

 private:
  void end(const std::string& layer, const std::string& why);

  std::function<void(const SpriteLife&)> show_;
  std::map<std::string, SpriteLife> alive_;
};

}  // namespace talisman::sequences
