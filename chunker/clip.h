// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Cutting a triangle at the near plane, at the guard band, and at one plane of the world where that is asked
/// for.
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
///
/// A half-space n · p ≥ d of the world is one of sprite points, too: with (X, Y, w) = M p + t
///
///   n' · (X, Y, w) ≥ d',   n' = M⁻ᵀ n,   d' = d + n' · t
///
/// so it cuts like the near plane does. A point whose n' · q - d' vanishes beside its terms lies on the
/// plane, and what lies on the plane is kept: a surface in the plane stays whole, whatever the rounding.

#include <array>
#include <optional>
#include <span>

#include "layers/geometry2.h"

namespace talisman::chunker {

inline constexpr double kGuardBandPx = 8192;
inline constexpr double kOnPlane = 1e-9;  ///< of the terms of a height: far less than 1/256 texel

/// The points p with normal · p ≥ offset. The normal may have any length.
struct HalfSpace {
  layers::dvec3 normal{0, 0, 0};
  double offset = 0;
  /// normal · p - offset; 0 where that is less than kOnPlane of its terms.
  double height(const layers::dvec3& p) const;
};

struct ClipRegion {
  double near_w = 0;  ///< > 0
  layers::dvec2 center_px{0, 0};
  std::optional<HalfSpace> kept{};  ///< of sprite points; empty: everything
};

/// A corner of the cut polygon, and the same material point as weights of the original corners.
struct ClipVertex {
  layers::dvec3 point;
  layers::dvec3 weights;
};

struct ClippedPolygon {
  std::array<ClipVertex, 9> vertices;  ///< a triangle and six planes: at most 3 + 6
  int count = 0;                       ///< < 3: nothing is left
};

ClippedPolygon clip_triangle(const std::array<layers::dvec3, 3>& corners, const ClipRegion& region);

}  // namespace talisman::chunker
