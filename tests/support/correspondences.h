// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Matched points for tests and benchmarks: the realistic workload, which the tool's experiments share
/// (sequences/experiments/warps/point_workload.h), and the hard cases, each defined once.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sequences/experiments/warps/point_workload.h"

namespace talisman::tests {

using layers::Affine2;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using sequences::exact_affine;
using sequences::exact_perspective;
using sequences::gentle_affine;
using sequences::gentle_perspective;
using sequences::moving_box;
using sequences::Pairs;
using sequences::Random;
using sequences::through;

/// Moves each point now by up to `amount_px` along each axis.
Pairs with_noise(Pairs pairs, std::uint64_t seed, double amount_px);

/// The same pairs on a display that is scaled by `scale`, turned and moved: both sides by one similarity.
Pairs in_similar_display(Pairs pairs, std::uint64_t seed, double scale);

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
