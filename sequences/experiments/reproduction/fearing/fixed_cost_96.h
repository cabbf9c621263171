// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do shared buffers cost on this machine, whatever is drawn into them? [F96 5.2, 5.3]
///
/// The thesis loses most of its best case to a fixed cost of 0.13 to 0.24 s a frame: prediction on the host and joining by
/// stencil. Here the scenarios, 1 % moving, N = 32, k = 2, are drawn by policy `predictive`, each frame, and by `direct`,
/// every tenth, side by side in one run:
///
///   speed-up    processor time of a frame by direct / by predictive, all threads, means
///   bound       20.16, what skipping allows (Table 5.30)
///   prediction  what planning takes more than direct's;   joining: copies, joins, clearing and the last step to a picture,
///               less direct's last step
///
/// A row says yes where the speed-up is a stated share of the bound (paper: 18.51, 15.11, 4.69, 4.04 and 2.77 of it), or both costs
/// together are no more than 2 ms a frame. Times of parts are of this machine, and vary with its load; processor times hardly do.

#include "sequences/experiments/reproduction/fearing/iris.h"
#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// Milliseconds of a frame, means.
struct FrameParts {
  double plan_ms = 0, draw_ms = 0, join_ms = 0;
  double cpu_ms = 0;  ///< of all threads
};

inline constexpr double kBound96 = 20.16, kFixed_ms = 2;

/// `share` of the bound that is asked for.
Finding fixed_cost_96(const FrameParts& direct, const FrameParts& predictive, double share);

Item fixed_cost_item_96();

}  // namespace talisman::sequences
