// SPDX-License-Identifier: Apache-2.0
#pragma once

/// When does something jump, so that no extrapolation of its motion can be right? Of the tracks of a scene: where a key
/// differs from the one before and follows it within a nanosecond, as where a swarm wraps around, and every key of a
/// stepwise channel that differs.

#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

inline constexpr double kJump_s = 1e-9;

/// Times of the keys behind the jumps, ascending, each once. Morph weights are no motion of a node, and left out; of
/// tracks that repeat all repetitions up to `end_s` count, and their return to the first key where it differs from the
/// last. Cost: O(keys + jumps · log jumps).
std::vector<double> jumps_of(const Scene& scene, double end_s);

/// Does one lie in after_s < t ≤ to_s?
bool any_between(const std::vector<double>& jumps, double after_s, double to_s);

}  // namespace talisman::layers
