// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which thresholds are the cheapest that hold a goal?
///
/// **One for all layers.** Quality is not monotone in a threshold, so nothing is concluded from one threshold about
/// another. All settings of the grid (thresholds.h) are planned. For the worst frame they are tried from the
/// cheapest on, until one holds: most fail in the first frames that are drawn. If that takes too many frames, and
/// for the mean, of which no single frame says enough, the rest is halved again and again between one that
/// failed and one that holds. For a budget of ms plans say all; the finest threshold that is within it is the answer.
///
/// **Per layer.** From there on layers are allowed more than others (layer_moves.h; for a budget: less), step by
/// step, as long as the goal holds and the cost falls (the displayed error falls).
///
/// What is said of an answer was measured on all its frames. Cost: at most ten times the frames of the range are
/// drawn, the truth among them.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "sequences/experiments/tuning/probe.h"

namespace talisman::sequences {

inline constexpr int kMostFullRenders = 10;

/// One setting that was planned, and what is known of its pictures.
struct TunePoint {
  PlannedThresholds plan;
  ProbedQuality quality;  ///< of pictures that were drawn; for a budget of ms: FLIP of those of the answers
};

struct TuneAnswer {
  TunePoint point;
  bool holds = false;
};

struct TuneReport {
  std::string sequence, file;
  layers::ivec2 display_px{0, 0};
  FrameRange range;
  std::string policy;
  TuneGoal goal;
  std::vector<std::string> layers;      ///< names, by entry of layer_specs
  std::vector<double> given_weights;    ///< importance.geometric, likewise
  double reference_ms = 0;              ///< modelled drawing time of all frames under policy `reference`
  std::vector<TunePoint> curve;         ///< the grid, ascending in px
  std::optional<TuneAnswer> common;     ///< one for all; not there: stopped before
  std::optional<TuneAnswer> per_layer;  ///< cheaper (for a budget: better) than that
  int frames_drawn = 0;
  bool is_stopped = false;

  int frames() const { return range.last - range.first + 1; }
  double full_renders() const { return double(frames_drawn) / frames(); }
  /// 0 … 1 of the reference.
  double cost_share(const PlannedThresholds& plan) const {
    return reference_ms > 0 ? plan.cost_ms / reference_ms : 0;
  }
};

/// `settings` as `resolve` makes them, of a policy that draws on thresholds. Files of the truth lie in `folder` meanwhile.
/// Throws OutputError. `stop` may be set by a signal handler: what is known so far is returned.
TuneReport tune(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                const TuneGoal& goal, const std::string& folder, ProgressKind progress,
                const std::atomic<bool>& stop);

}  // namespace talisman::sequences
