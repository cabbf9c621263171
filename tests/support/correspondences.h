// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Matched points for tests, benchmarks and experiments: one realistic workload and the hard cases, each
/// defined once.
///
/// The workload: a box of random shape is seen at 1024 × 1024 with a vertical field of view of 45°, turned by
/// 0.2 … 3° about a random axis through its centre and moved by at most 2 % of its distance along each axis.
/// That is what a sprite lives through between two renders. Everything is a pure function of its seed, on any
/// platform.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::tests {

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

/// The workload. Points 0 … 7 are the corners, 8 … 13 the face centres, 14 … 25 the edge centres, further
/// ones are inside.
Pairs moving_box(std::uint64_t seed, int points);

/// Points then at random in a square of the given half side about `centre`; now = `map` of them.
Pairs exact_affine(std::uint64_t seed, int points, const Affine2& map, double half_side_px = 100,
                   dvec2 centre = {512, 512});
/// The same through a homography (denominators must be positive there).
Pairs exact_perspective(std::uint64_t seed, int points, const dmat3& map, double half_side_px = 100,
                        dvec2 centre = {512, 512});
/// Moves each point now by up to `amount_px` along each axis.
Pairs with_noise(Pairs pairs, std::uint64_t seed, double amount_px);

dvec2 through(const dmat3& map, dvec2 p);
/// A map near the identity: turned, scaled and sheared a little about (512, 512), moved by some pixels;
/// positive determinant.
Affine2 gentle_affine(std::uint64_t seed);
/// The same with a horizon some thousands of pixels away.
dmat3 gentle_perspective(std::uint64_t seed);

/// Points on a line at `angle_rad`, each off it by up to `thickness` × the length of the line; now = turned,
/// stretched, noise of 1 px.
Pairs near_collinear(std::uint64_t seed, int points, double thickness, double angle_rad,
                     double length_px = 200);

/// A named input that a careless solver gets wrong.
struct HardCase {
  std::string name;
  Pairs pairs;
  bool finite = true;  ///< false: at least one coordinate is NaN or infinite
};
/// Empty, one, two, three points; coincident; collinear at several angles; near-collinear 1e-3 … 1e-12; two
/// clusters; sprites of 1e-3 to 1e5 px at offsets to 1e8 px; duplicates; mirrored; collapsed to a line and to
/// a point; turned by 180°; horizon among the points; near-plane blow-up; NaN and infinity; identical.
std::vector<HardCase> hard_cases();

/// Anything at all: random counts, magnitudes 1e-300 … 1e300, repeated values, now and then NaN and infinity.
Pairs garbage(std::uint64_t seed);

/// The largest and the root mean square distance of map(then) from now. Slow and plain; the oracle of
/// measure().
double largest_error(const Pairs& pairs, const std::function<dvec2(dvec2)>& map);
double rms_error(const Pairs& pairs, const std::function<dvec2(dvec2)>& map);

}  // namespace talisman::tests
