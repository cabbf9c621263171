// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Matched points on which warps are measured: the same workload for the tool, the tests and the benchmarks.
///
/// The workload: a box of random shape is seen at 1024 × 1024 with a vertical field of view of 45°, turned by
/// 0.2 … 3° about a random axis through its centre and moved by at most 2 % of its distance along each axis.
/// That is what a sprite lives through between two renders. Beside it, points that an exact map carries,
/// whose optimum is known: 0. Everything is a pure function of its seed, on any platform.

#include <cstdint>
#include <functional>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::sequences {

using layers::Affine2;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;

/// SplitMix64: the standard distributions give other numbers on other platforms.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform(double lo, double hi);
  int integer(int lo, int hi);  ///< both included
  double log_uniform(double lo, double hi);
  dvec2 in_square(double half_side);

 private:
  std::uint64_t state_;
};

struct Pairs {
  std::vector<dvec2> then_px, now_px;
  std::size_t size() const { return then_px.size(); }
};

/// The same points in space, camera at the origin, looking along -z, y up; metres.
struct SpacePairs {
  std::vector<dvec3> then_m, now_m;
};

/// The workload. Points 0 … 7 are the corners, 8 … 13 the face centres, 14 … 25 the edge centres, further
/// ones are inside.
Pairs moving_box(std::uint64_t seed, int points);
SpacePairs moving_box_in_space(std::uint64_t seed, int points);
/// The display and the vertical field of view of the workload.
inline constexpr int kWorkloadDisplay_px = 1024;
inline constexpr double kWorkloadFov_rad = 0.78539816339744831;

/// Points then at random in a square of the given half side about `centre`; now = `map` of them.
Pairs exact_affine(std::uint64_t seed, int points, const Affine2& map, double half_side_px = 100,
                   dvec2 centre = {512, 512});
/// The same through a homography (denominators must be positive there).
Pairs exact_perspective(std::uint64_t seed, int points, const dmat3& map, double half_side_px = 100,
                        dvec2 centre = {512, 512});
dvec2 through(const dmat3& map, dvec2 p);
/// A map near the identity: turned, scaled and sheared a little about (512, 512), moved by some pixels;
/// positive determinant.
Affine2 gentle_affine(std::uint64_t seed);
/// The same with a horizon some thousands of pixels away.
dmat3 gentle_perspective(std::uint64_t seed);

}  // namespace talisman::sequences
