// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/decision_history.h"

#include <algorithm>

namespace talisman::sequences {

LayerHistory& DecisionHistory::of(const std::string& layer) {
  const auto known = std::find_if(all_.begin(), all_.end(), [&](const auto& l) { return l.layer == layer; });
  if (known != all_.end()) return *known;
  all_.push_back({layer, nullptr, {}, {}});
  return all_.back();
}

void DecisionHistory::add(const nlohmann::ordered_json& line) {
  const int frame = line.at("frame").get<int>();
  LayerHistory& layer = of(line.at("layer").get_ref<const std::string&>());
  const bool is_drawn = line.at("decision") == "rerender";
  last_frame_ = frame;
  if (frame < frame_ && is_drawn) layer.drawn_before = frame;
  if (frame == frame_) layer.line = line;
  if (frame > frame_ && is_drawn && !layer.drawn_after) layer.drawn_after = frame;
}

std::vector<LayerHistory> DecisionHistory::layers() const {
  std::vector<LayerHistory> shown;
  for (const LayerHistory& layer : all_)
    if (!layer.line.is_null()) shown.push_back(layer);
  return shown;
}

bool DecisionHistory::is_complete() const {
  return std::all_of(all_.begin(), all_.end(),
                     [](const LayerHistory& l) { return l.line.is_null() || l.drawn_after; });
}

}  // namespace talisman::sequences
