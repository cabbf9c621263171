// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Cutting a triangle at the near plane and at the guard band.
///
/// Vertices are homogeneous sprite points (X, Y, w): the texel is (X/w, Y/w) and w is the depth along the
/// view axis. The region kept is
///
///   w ≥ near,   |X/w - cx| ≤ G,   |Y/w - cy| ≤ G      (c: centre of the sprite, G = kGuardBandPx)
///
/// The guard band is far wider than any sprite, so almost every triangle that sticks out of the sprite is
/// left whole; only coordinates that would not fit the rasteriser's fixed point are cut. There is no far
/// plane: a sky may be as large as it likes. Each crossing is computed from its inner to its outer end, so
/// two triangles cut their shared edge at the same point.

#include <array>
#include <span>

#include "layers/geometry2.h"

namespace talisman::chunker {

inline constexpr double kGuardBandPx = 8192;

struct ClipRegion {
  double near_w = 0;  ///< > 0
  layers::dvec2 center_px{0, 0};
};

/// A corner of the cut polygon, and the same material point as weights of the original corners.
struct ClipVertex {
  layers::dvec3 point;
  layers::dvec3 weights;
};

struct ClippedPolygon {
  std::array<ClipVertex, 8> vertices;  ///< a triangle and five planes: at most 3 + 5
  int count = 0;                       ///< < 3: nothing is left
};

ClippedPolygon clip_triangle(const std::array<layers::dvec3, 3>& corners, const ClipRegion& region);

}  // namespace talisman::chunker
