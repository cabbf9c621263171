// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Policy Predictive: how the buffers of a plan are cut and joined (regulator/plan_tree.h). The frames of a slice are
/// LookaheadOptions::frames, δ is Thresholds::geometric_px.

#include "regulator/plan_intervals.h"
#include "regulator/plan_tree.h"
#include "regulator/projected_motion.h"

namespace talisman::regulator {

struct PredictiveOptions {
  int children = 2;  ///< k ≥ 2, of which the frames of a slice are a power: PlanShape::children
  Joining joining = Joining::InPlace;      ///< the fewest joins; all ways show the same
  MotionNorm norm = MotionNorm::Euclid;    ///< Axis draws less, and may be √2 δ off
  Intervals intervals = Intervals::Fixed;  ///< Data: fewer drawings, and a search for each slice
  /// The slice is 1 / k as long after a surprise (sequences/pipeline/predictive/slices.h), and k times as long after two
  /// without one, up to the frames of a slice: what may be dropped is shorter, and what rests is drawn more often.
  bool adaptive = false;
  bool operator==(const PredictiveOptions&) const = default;
};

}  // namespace talisman::regulator
