// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp gives the better picture for the same number of renders? [LS97 4.2, second series]
///
/// For each curve the relation of threshold and update rate is inverted, so that all curves draw the object
/// about equally often; then the same animation is drawn by the real pipeline (step.h) with that curve and
/// threshold, and every frame is compared with the policy `reference`. The paper judged by eye.

#include <vector>

#include "sequences/experiments/warps/update_rate.h"
#include "sequences/pictures/quality.h"

namespace talisman::sequences {

struct RateOptions {
  double update_rate = 0.2;            ///< renders per frame that each curve may spend; (0, 1]
  int frames = 50;                     ///< ≥ 1; cost grows in proportion
  double fps = 10;                     ///< > 0; fewer make larger steps from frame to frame
  layers::ivec2 display_px{256, 256};  ///< cost grows with the area
  layers::BoundKind bound = layers::BoundKind::Box8;
};

struct CurveQuality {
  warp::Curve curve{};
  double threshold_px = 0;  ///< the smallest at which the update rate is kept
  int renders = 0;          ///< of the pipeline: equal to those of the simulation
  Quality mean, worst;      ///< over all frames, see DiffSummary
};

/// One entry per curve of all_curves(). Only the geometric fiducial regulates. Cost: fourteen runs of the
/// animation and one of `reference`; the runs are independent jobs.
std::vector<CurveQuality> quality_at_rate(const layers::Scene& scene, const RateOptions& options = {});

}  // namespace talisman::sequences
