// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The scene at other instants than that of the frame: sprites, chunks and shadow maps are drawn as of their own.

#include <map>
#include <utility>

#include "sequences/pipeline/latency/known_scene.h"

namespace talisman::sequences {

/// The scene at the instants of the sprites and the shadow maps that a frame draws.
class Instants {
 public:
  Instants(const Pipeline& pipeline, int frame, const layers::SceneFrame& now)
      : pipeline_(pipeline), frame_(frame), now_(now) {}
  /// As it was expected in frame `known`.
  const layers::SceneFrame& at(int known, int instant) {
    if (known == frame_ && instant == frame_) return now_;
    const auto [it, is_new] = others_.try_emplace({known, instant});
    if (is_new) it->second = scene_expected(pipeline_, known, instant);
    return it->second;
  }

 private:
  const Pipeline& pipeline_;
  int frame_;
  const layers::SceneFrame& now_;
  std::map<std::pair<int, int>, layers::SceneFrame> others_;
};

}  // namespace talisman::sequences
