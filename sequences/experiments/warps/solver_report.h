// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Every rung of the ladder of solvers (solver_ladder.h) on the realistic workload with 4, 8, 14, 26 and 64
/// points: time, accuracy against the certified optimum, and stability (solver_measure.h).
///
/// - solvers.csv: one line per solver and number of points
/// - solvers.svg: time against the largest error in pixels, 14 points, all families; the Pareto front is
///   marked
/// - solvers-affine.svg, solvers-perspective.svg: time against the excess over the certified optimum
/// - solvers.html: all of it as a page
///
/// All but the times, and who is on the front by them, is the same in every run.

#include <array>
#include <string>
#include <vector>

#include "sequences/experiments/warps/solver_measure.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

/// Numbers of points that the solvers are run on.
inline constexpr std::array kPointCounts = {4, 8, 14, 26, 64};

/// One rung with everything that was measured.
struct MeasuredSolver {
  Solver solver;
  std::array<FitTime, kPointCounts.size()> times;
  std::array<FitAccuracy, kPointCounts.size()> accuracies;
  FitStability stability;
  int inputs = 0;
  bool on_front = false;  ///< nothing else is as quick and as accurate
};

using MeasuredSolvers = std::vector<MeasuredSolver>;

/// The whole ladder. `inputs` ≥ 1: boxes per number of points; slow solvers take 16 at most. Cost: in
/// proportion to `inputs`, half a minute with 200.
MeasuredSolvers measure_solvers(int inputs, ProgressKind progress);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const MeasuredSolvers& solvers, const std::string& dir);

Page page_of(const MeasuredSolvers& solvers);

}  // namespace talisman::sequences
