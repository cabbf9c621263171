// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The renderers' workload: a displaced sphere with a checkerboard of 512² texels, 1024², Gouraud, bilinear.

#include <vector>

#include "layers/scene.h"

namespace talisman::bench {

inline constexpr layers::ivec2 kPicture{1024, 1024};

/// About `triangles` of them, one part.
layers::Scene ball(int triangles);

/// One picture of 8-bit *linear* RGBA, row by row from the top. Ours is decoded to it from square roots; a peer's
/// texture is decoded beforehand, so that both light in linear space.
using LinearBytes = std::vector<unsigned char>;

}  // namespace talisman::bench
