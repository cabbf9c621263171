// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes that are ready to be drawn, kept for all pictures of them: to make the pyramids of their textures costs seconds,
/// a frame milliseconds.

#include <list>
#include <memory>
#include <optional>
#include <string>

#include "chunker/render.h"
#include "sequences/view/live_scene.h"

namespace talisman::sequences {

/// What is drawn for the same scene, effects and shading.
struct ReadyScene {
  std::string key;
  std::shared_ptr<const layers::Scene> read;   ///< as it was read
  std::shared_ptr<const layers::Scene> drawn;  ///< without the effects that are off
  std::shared_ptr<layers::Scene> flown{};      ///< the same as `drawn` where the camera is flown; else null
  std::optional<chunker::PreparedScene> prepared{};
};

class ReadyScenes {
 public:
  static constexpr std::size_t kMost = 2;

  /// Finds what is kept for such a scene, or makes it; `live` then shares its scene.
  std::shared_ptr<const ReadyScene> of(LiveScene& live, const ViewRequest& request);

 private:
  std::list<std::shared_ptr<const ReadyScene>> scenes_;  ///< the one asked for last is the first
};

}  // namespace talisman::sequences
