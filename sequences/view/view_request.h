// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A request of the page, from its JSON.
///
///   {"tab": "a1", "request": 17, "settings": {"policy": "budget", "budget-ms": 5}, "without": ["shadow_map"],
///    "flight": [[px, py, pz, tx, ty, tz], …], "frame": 12, "mode": "flip", "scale": 0.5, "from": 0, "name": "dive"}
///
/// All but `tab` and `request` may be left out.

#include <cstdint>
#include <string>
#include <vector>

#include "layers/effect.h"
#include "layers/scene.h"

namespace talisman::sequences {

/// Where a flight's camera is in one frame, and a place that it looks at. World, metres.
struct CameraPose {
  layers::dvec3 position{0, 0, 0}, target{0, 0, -1};
  bool operator==(const CameraPose&) const = default;
};

struct ViewRequest {
  std::string tab;                      ///< of the browser; one plan each
  std::int64_t request = 0;             ///< grows; what a tab asked before is stale
  std::vector<std::string> words;       ///< "--policy=budget"
  std::vector<layers::Effect> without;  ///< effects that are off
  std::vector<CameraPose> flight;       ///< one per frame; empty: the sequence's own camera
  int frame = 0, from = 0;
  std::string mode = "shown", layer, name;
  double scale = 1;  ///< (0, 1]: of the display, of pictures while something moves

  /// The same for requests with the same settings, effects, flight and scale: one plan.
  std::string plan_key() const;
};

/// Throws InputError that names what is wrong.
ViewRequest view_request_from(const std::string& body);

/// Options that the page may set, "geometric-px"; none of them names a file.
const std::vector<std::string>& settable_options();

}  // namespace talisman::sequences
