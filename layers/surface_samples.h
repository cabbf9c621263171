// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which few points of the surfaces themselves stand for what a bounding polyhedron does not see?
///
/// The vertices of a bounding polyhedron follow a rigid body exactly. Of a body that deforms they follow the
/// bounds alone: an arm may turn inside a box that stands still. And light may fall on the middle of a face
/// and miss all its corners. Samples are material points: barycentric places in triangles of the meshes, which
/// move as the surface does. They are chosen among the vertices and a grid inside the large triangles, each
/// as far as can be from those chosen before (Gonzalez 1985: within a factor 2 of the best cover of so many),
/// under two distances in turn:
///
///   place, facing   ‖p - q‖ / extent + kFacing ‖n - m‖                   at the beginning
///   own motion      max over kInstants times of ‖r(p) - r(q)‖            r: what is left of the motion when the
///                                                                        body's best affine map is taken off it
///
/// so that the mouth of a face that speaks is found as well as the feet of a figure that walks.
///
/// Samples do not bound a surface: what they say is an *estimate*, and too small by what happens between
/// them. Measured on six skinned and morphed test models (docs/bound.md): of the largest error over all
/// vertices 16 samples beside the polyhedron miss 7 % or less in the mean and 25 % at most, but in one model
/// 33 % and 51 %; 64 samples miss 1 % and 8 %, in that one 15 % and 29 %. The polyhedron alone misses 10 … 68 %
/// in the mean.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

inline constexpr int kDefaultMaterialPoints = 16;
inline constexpr int kMostMaterialPoints = 1024;

/// A place on a part's surface.
struct SurfaceSample {
  int part = -1;                          ///< index into Scene::parts
  std::array<std::uint32_t, 3> vertex{};  ///< a triangle of its mesh
  dvec3 weight{1, 0, 0};                  ///< barycentric, sum 1
};

/// A sample somewhere: its place, and the unit normal of its triangle (zero where that has no area).
struct SurfacePlace {
  dvec3 position{0, 0, 0}, normal{0, 0, 0};
};

/// `count` samples of these parts; fewer where there are not as many different places. `of_motion`: every
/// second one by its own motion. Cost: O(vertices · (count + instants)), once per body.
std::vector<SurfaceSample> spread_samples(const Scene& scene, std::span<const int> parts, int count,
                                          bool of_motion);

/// Where the samples are in the world at `frame`, appended in their order; samples of one part are to follow
/// each other. Cost: O(samples + joints).
void append_sample_places(const SceneFrame& frame, std::span<const SurfaceSample> samples,
                          std::vector<SurfacePlace>& places);

}  // namespace talisman::layers
