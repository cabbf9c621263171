// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/sprite_lives.h"

#include <algorithm>

namespace talisman::sequences {

void SpriteLives::end(const std::string& layer, const std::string& why) {
  const auto life = alive_.find(layer);
  if (life == alive_.end()) return;
  life->second.ended = why;
  show_(life->second);
  alive_.erase(life);
}

void SpriteLives::add(const nlohmann::ordered_json& decision) {
  const auto& layer = decision.at("layer").get_ref<const std::string&>();
  const auto& what = decision.at("decision").get_ref<const std::string&>();
  const auto& reason = decision.at("reason").get_ref<const std::string&>();
  const int frame = decision.at("frame").get<int>();
  const auto life = alive_.find(layer);
  const bool goes_on = life != alive_.end() && life->second.end == frame;
  if (life != alive_.end() && !goes_on) end(layer, "");
  if (what == "drop") return end(layer, reason);
  const double shown_px = decision.at("geometric_px").is_null() ? 0 : decision["geometric_px"].get<double>();
  if ((what == "reuse" || what == "refresh") && goes_on) {
    life->second.end = frame + 1;
    life->second.max_geometric_px = std::max(life->second.max_geometric_px, shown_px);
    return;
  }
  end(layer, reason);
  alive_[layer] = {layer, decision, what == "rerender", frame, frame + 1, shown_px, ""};
}

void SpriteLives::finish() {
  while (!alive_.empty()) end(std::string(alive_.begin()->first), "");
}

}  // namespace talisman::sequences
