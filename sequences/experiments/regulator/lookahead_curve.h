// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How many renders does knowing the motion N frames ahead save? Policy lookahead over N, between `threshold`
/// and `oracle` (all of the sequence known), all under the same bound. With N = 0 sprites are drawn as of
/// now, as `threshold` draws them; what differs is how far clipped ones grow, since `threshold` grows them by
/// how long the last one lasted. Plans only: no pixel is drawn.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

struct LookaheadPoint {
  std::string prediction;  ///< how the coming motion is known: "known motion"
  int frames = 0;          ///< N
  std::int64_t renders = 0;
  double mean_update_rate = 0;  ///< 0 … 1
  double max_geometric_px = 0;  ///< displayed; a wrong prediction does not break the bound, it costs renders
  double plan_us = 0;           ///< measured, per layer and frame
};

struct LookaheadCurve {
  double geometric_px = 0;  ///< the bound
  layers::ivec2 display_px{0, 0};
  std::int64_t threshold_renders = 0, oracle_renders = 0;
  double threshold_rate = 0, oracle_rate = 0;  ///< mean update rates, 0 … 1
  std::vector<LookaheadPoint> points;          ///< by prediction, N ascending
};

/// 0, 1, 2, 4, … 64.
std::vector<int> compared_lookaheads();

/// `settings` gives the bound and all else; its policy is not used. Cost: ten plans of the range.
LookaheadCurve lookahead_curve(const Sequence& sequence, const Settings& settings,
                               const ExperimentFrames& frames);

}  // namespace talisman::sequences
