// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a solver cost, how close does it come, and where does it break?
///
/// Time: small batches of consecutive inputs of the realistic workload on the steady clock, each run three
/// times, the quickest counts; a batch is long enough for the clock (some microseconds, at most 16 fits) and
/// short enough to show the slow inputs. Median and 99th percentile over the batches, per fit.
///
/// Accuracy: with opt the certified lower bound of the smallest maximum that the solver's family allows
/// (curve …i at a gap of 1e-9), and rms_opt the least root mean square found by any fit of that family,
///
///   excess = (max_px - opt) / max(opt, 1e-6 px)          rms excess likewise
///
/// Stability: points that an exact map of the family carries must be carried to within 1e-3 px. The largest
/// power of ten that a sprite of 100 px can be away from the origin, and the smallest sprite at (700, 700),
/// by powers of ten, such that this and all tamer ones keep it. A fit that falls back to a simpler family for
/// a sprite smaller than the tolerance keeps it, too, and rightly so.

#include <vector>

#include "sequences/experiments/warps/solver_ladder.h"

namespace talisman::sequences {

/// Inputs of one size with their certified optima, shared by all solvers.
struct Workbench {
  int points = 0;
  std::vector<LadderInput> inputs;
  /// By family (as an index) and input, px.
  std::vector<std::vector<double>> least_max_px, least_rms_px;
};
/// Inputs 0 … count - 1 of the workload. Cost: about 0.2 ms per input, mostly Ceres.
Workbench make_workbench(int points, int count);

struct FitTime {
  double median_us = 0, p99_us = 0;
};

/// The batches of one solver over the first `count` inputs of a workbench, which must outlive it.
class TimedSolver {
 public:
  TimedSolver(const Solver& solver, const Workbench& bench, int count);
  void run_round();
  FitTime result() const;  ///< after at least one round

 private:
  double run_batch(std::size_t first, std::size_t last) const;
  std::vector<ReadyFit> fits_;
  std::size_t batch_ = 1;
  std::vector<double> best_us_;  ///< per batch, per fit
};

struct FitAccuracy {
  /// Mean of the largest error over the whole workbench; of a solver that was run on the first inputs only,
  /// its mean there times how much harder the whole is: Σ least_max over all ÷ over those.
  double mean_max_px = 0;
  double mean_excess = 0, worst_excess = 0;  ///< of the maximum, relative; 0 best
  double mean_rms_excess = 0;
  int unfinished = 0;   ///< fits whose status is not Converged
  int uncertified = 0;  ///< fits that broke their promised gap; only solvers with a certificate
};
FitAccuracy accuracy_of(const Solver& solver, const Workbench& bench, int count);

struct FitStability {
  double largest_offset_px = 0;   ///< 0: not even at 1 px; 1e15 is the end of the search
  double smallest_sprite_px = 0;  ///< infinity: not even at 1000 px; 1e-12 is the end of the search
};
FitStability stability_of(const Solver& solver);

}  // namespace talisman::sequences
