// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy`: what accuracy costs in time. One experiment at a time:
///
///   --solvers              of a warp; experiments/warps/solver_report.h
///   --regulator SEQUENCE   of the whole pipeline; accuracy_regulator.h
///   --renderer SEQUENCE    of every knob and every effect of the renderer; accuracy_renderer.h
///   --factoring SEQUENCE   of shading in sprites of its own; accuracy_factoring.h
///   --predictive SEQUENCE  of buffers that parts share by their motion; motion/accuracy_predictive.h
///   --amortised SEQUENCE   of layers that share sprites while it runs; motion/accuracy_amortised.h
///   --lod SEQUENCE         of levels of detail; motion/accuracy_lod.h
///   --latency SEQUENCE     nothing: error over the age of the camera's pose; motion/accuracy_latency.h
///   --culling SEQUENCE     nothing: which structure finds what is in view; culling/accuracy_culling.h
///   --visibility SEQUENCE  of what is not drawn because nobody sees it: nothing; likewise
///   --memory SEQUENCE      nothing: how far ahead is best read what may be seen; likewise
///   --hard                 nothing: whether every stage gets right what is hard; accuracy_hard.h

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"

namespace talisman::sequences {

struct AccuracyOptions {
  bool solvers = false;  ///< exactly one of the experiments must be asked for
  bool hard = false;     ///< likewise
  // A sequence each; empty: not asked for.
  std::string regulator, renderer, factoring, predictive, amortised, latency, lod, culling, visibility,
      memory;
  ExperimentOptions of_sequence;  ///< all but its sequence
  std::string out = "out/accuracy";
  std::string progress = "auto";  ///< auto, bar, plain or none
  /// Boxes per number of points, 1 … 100000; more sharpen the percentiles, cost in proportion.
  int inputs = 200;
};

/// Throws InputError and OutputError.
int run_accuracy(const AccuracyOptions& options, std::ostream& out);

}  // namespace talisman::sequences
