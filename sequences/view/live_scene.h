// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From a request to what is planned or drawn: settings, effects that are off, a flown camera, a coarser display.

#include <memory>

#include "sequences/view/view_request.h"
#include "sequences/view/view_source.h"

namespace talisman::sequences {

inline constexpr int kLargestLiveDisplay_px = 4096;

/// Owns its scene where the camera is flown; else shares that of the sequence.
struct LiveScene {
  Variant variant;
  std::shared_ptr<const layers::Scene> read;  ///< as it was read, with all effects and its own camera
  std::shared_ptr<layers::Scene>
      flown{};  ///< the same as variant.sequence.scene; null: the sequence's own camera
};

/// Throws InputError, as the tool would say it.
LiveScene live_scene(const ViewSource& source, const ViewRequest& request);

}  // namespace talisman::sequences
