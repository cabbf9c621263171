// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small pictures that repeat, as content is baked from them: linear RGB, bilinear lookup.

#include <vector>

#include "layers/scene.h"

namespace talisman::sequences {

struct TileImage {
  int width = 0, height = 0;
  std::vector<layers::vec3> texels;  ///< row by row

  /// At u, v (any finite value, one repetition per unit), bilinear.
  layers::vec3 operator()(double u, double v) const;
};

/// sRGB bytes to linear light.
TileImage linear_tile(const layers::Texture& texture);

/// What covers: alpha where the picture has it, else its first channel as it is. All three components are the
/// same.
TileImage cover_tile(const layers::Texture& texture);

/// The mean of 2 × 2 texels, again and again, while a texel is smaller than three quarters of `texel_m`: what
/// is finer than a baked texture would only alias in it. `tile_m` is the size of one repetition. Stops at odd
/// sides.
TileImage reduced_tile(TileImage tile, double tile_m, double texel_m);

}  // namespace talisman::sequences
