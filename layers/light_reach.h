// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which lights reach a layer? The part of layers/shading.h that looks at the scene in motion.
///
/// The layer is the ball around the middle of its vertices' bounds, with radius r; a light at l with axis a
/// and outer angle θ reaches it where, with m the middle and d = |m - l|,
///
///   range   d - r < range
///   cone    angle(m - l, a) <= θ + asin(r / d), or d <= r
///   side    of a flat surface that is not two-sided: the light is on the side that it faces
///
/// at one of kReachTimes times. Nothing is said of what stands between.

#include "layers/shading.h"

namespace talisman::layers {

/// Evenly over the scene's keys, or over the longest turn of what spins if that is longer.
inline constexpr int kReachTimes = 33;

}  // namespace talisman::layers
