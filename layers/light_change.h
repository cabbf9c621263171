// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Can the light on a layer change at all? If not, nothing that follows its shading is called for.
///
/// It can where a lit part and a light that is not ambient move against each other, or where a lit part is
/// specular and moves against the eye. What a light and a part are carried by is told from the tracks alone:
/// a lamp on a car that lights only that car does not change.

#include <span>
#include <string>
#include <string_view>

#include "layers/layer.h"

namespace talisman::layers {

struct LightChange {
  std::string why;                ///< who moves against whom; empty if nothing can change
  std::string_view why_not = "";  ///< empty if it can change
  bool possible() const { return why_not.empty(); }
};

/// `carriers` are those of the scene's nodes (layers/animation.h). Cost: O(parts · lights).
LightChange light_change_of(const Scene& scene, const Layer& layer, std::span<const int> carriers);

}  // namespace talisman::layers
