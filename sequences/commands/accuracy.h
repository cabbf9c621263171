// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy`: what accuracy costs in time. One experiment at a time:
///
///   --solvers              of a warp; below
///   --regulator SEQUENCE   of the whole pipeline; regulator_command.h
///   --renderer SEQUENCE    of every knob and every effect of the renderer; renderer_command.h
///   --factoring SEQUENCE   of shading in sprites of its own; factoring_command.h
///
/// Every rung of the ladder (solver_ladder.h) on the realistic workload with 4, 8, 14, 26 and 64 points:
/// time, accuracy against the certified optimum, and stability (solver_measure.h). A table on stdout, and in
/// DIR:
///
///   solvers.csv   one line per solver and number of points
///   solvers.svg   time against the largest error in pixels, 14 points, all families; the Pareto front is marked
///   solvers-affine.svg, solvers-perspective.svg   time against the excess over the certified optimum
///
/// All but the times is the same in every run.

#include <iosfwd>
#include <string>

#include "sequences/commands/accuracy_regulator.h"

namespace talisman::sequences {

struct AccuracyOptions {
  bool solvers = false;               ///< exactly one of the experiments must be asked for
  RegulatorCommandOptions regulator;  ///< asked for by its sequence
  std::string renderer;               ///< sequence, empty: not asked for; the rest is that of `regulator`
  std::string factoring;              ///< sequence, empty: not asked for; the rest is that of `regulator`
  std::string out = "out/accuracy";
  std::string progress = "auto";  ///< auto, bar, plain or none
  int inputs =
      200;  ///< boxes per number of points, 1 … 100000; more sharpen the percentiles, cost in proportion
};

/// Throws InputError and OutputError.
int run_accuracy(const AccuracyOptions& options, std::ostream& out);

}  // namespace talisman::sequences
