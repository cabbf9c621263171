// SPDX-License-Identifier: Apache-2.0
#include "chunker/shadow_map.h"

namespace talisman::chunker {

float ShadowMap::visibility(const layers::dvec3&) const { return 1; }
std::int64_t ShadowMap::bytes() const { return 0; }

ShadowMap make_shadow_map(const layers::SceneFrame&, int, std::span<const int>,
                          const layers::ShadowMapOptions&) {
  return {};
}

ShadowMap make_shadow_map(const layers::SceneFrame& frame, int light, std::span<const int> casters) {
  return make_shadow_map(frame, light, casters, frame.scene->lights[light].shadow);
}

}  // namespace talisman::chunker
