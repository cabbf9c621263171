// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a mesh cost at each level of detail, and how far is each from the mesh itself? [Fu93 3.1]
///
/// A ladder has the mesh as it is first, level 0, and then coarser ones, each with at most half of the triangles of the
/// one above ("at least double the number of polygons in each successively higher LOD"). How they are made:
/// layers/lod/simplify.h.

#include <cstdint>
#include <string>
#include <vector>

namespace talisman::layers {

/// One level.
struct LadderLevel {
  int mesh = -1;               ///< index into Scene::meshes; -1: not placed in a scene yet
  std::int64_t triangles = 0;  ///< ≥ 1
  std::int64_t vertices = 0;   ///< that its triangles use
  std::int64_t bytes = 0;      ///< of its vertex arrays and indices in memory
  double error_m =
      0;  ///< how far its surface is from that of level 0, either way, in the space of the mesh; 0
          ///< for level 0; ≥ 0, and never below that of the level above
  bool operator==(const LadderLevel&) const = default;
};

struct Ladder {
  std::vector<LadderLevel> levels;  ///< finest first; one alone: there is nothing coarser; none: no mesh
  int coarsest() const { return static_cast<int>(levels.size()) - 1; }
  bool operator==(const Ladder&) const = default;
};

/// First broken rule ("level 2 has 700 triangles, must be at most half of the 1000 of the level above"), or empty.
std::string first_defect(const Ladder& ladder);

/// How far a picture of a level is from that of the mesh at most, px:
///
///   f e √(1 + t²) / (z - e)        e  error of the level, metres in the world        f  focal length, px
///                                  z  depth of its nearest point, m                  t  tangent of the angle to the axis
///
/// since x'/z' - x/z = (δx - t δz) / z' for a point that is moved by δ, |δ| ≤ e, and z' ≥ z - e. kMostLevelError_px where
/// z ≤ e.
inline constexpr double kMostLevelError_px = 1e6;
double level_error_px(double error_m, double nearest_m, double focal_px, double most_tangent);

}  // namespace talisman::layers
