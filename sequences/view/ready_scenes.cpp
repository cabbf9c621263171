// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/ready_scenes.h"

#include <algorithm>

namespace talisman::sequences {

namespace {

/// What of a request the drawn scene depends on, apart from the scene that was read.
std::string key_of(const LiveScene& live, const ViewRequest& request) {
  const chunker::RenderOptions& render = live.variant.settings.render;
  std::string key = live.flown ? "flown" : "own";
  key += " " + std::to_string(static_cast<int>(render.shading)) + std::to_string(render.mipmaps) +
         std::to_string(static_cast<int>(render.filter));
  for (const layers::Effect effect : request.without) key += " " + std::string(layers::name(effect));
  return key;
}

}  // namespace

std::shared_ptr<const ReadyScene> ReadyScenes::of(LiveScene& live, const ViewRequest& request) {
  const std::string key = key_of(live, request);
  const auto found = std::find_if(scenes_.begin(), scenes_.end(), [&](const auto& scene) {
    return scene->read == live.read && scene->key == key;
  });
  if (found != scenes_.end()) {
    scenes_.splice(scenes_.begin(), scenes_, found);
  } else {
    auto made =
        std::make_shared<ReadyScene>(ReadyScene{key, live.read, live.variant.sequence.scene, live.flown});
    made->prepared.emplace(*made->drawn, live.variant.settings.render);
    if (scenes_.size() >= kMost) scenes_.pop_back();
    scenes_.push_front(std::move(made));
  }
  live.variant.sequence.scene = scenes_.front()->drawn;
  live.flown = scenes_.front()->flown;
  return scenes_.front();
}

}  // namespace talisman::sequences
