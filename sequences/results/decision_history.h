// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What was decided about each layer in one frame, and when it was drawn before and after: from the lines of
/// decisions.jsonl, in their order, as they are written or read.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

/// One layer, aggregate or shadow map.
struct LayerHistory {
  std::string layer;
  nlohmann::ordered_json line;      ///< of the frame; null: has none
  std::optional<int> drawn_before;  ///< the last frame before it in which it was drawn
  std::optional<int> drawn_after;   ///< the first frame after it
};

class DecisionHistory {
 public:
  explicit DecisionHistory(int frame) : frame_(frame) {}
  /// A line, parsed. Frames do not fall. Throws nlohmann::json::exception if it is none.
  void add(const nlohmann::ordered_json& line);

  /// The layers that have a line in the frame, in its order.
  std::vector<LayerHistory> layers() const;
  /// Have all of these been drawn after the frame?
  bool is_complete() const;
  int last_frame() const { return last_frame_; }  ///< of the lines added; -1: none

 private:
  LayerHistory& of(const std::string& layer);
  int frame_, last_frame_ = -1;
  std::vector<LayerHistory> all_;
};

}  // namespace talisman::sequences
