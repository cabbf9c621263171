// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does a camera's file cut off what we draw? Nothing is cut at a far plane here: what lies behind it is drawn, and said.

#include <string>

#include "layers/scene.h"

namespace talisman::sequences {

/// "what lies beyond the far plane of camera 'eye', 10 m, is drawn all the same", if anything does at time 0; else
/// empty. Cost: O(vertices).
std::string beyond_far_plane(const layers::Scene& scene, const layers::Camera& camera);

}  // namespace talisman::sequences
