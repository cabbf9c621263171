// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy.h"

#include <ostream>

#include "sequences/commands/accuracy_factoring.h"
#include "sequences/commands/accuracy_hard.h"
#include "sequences/commands/accuracy_regulator.h"
#include "sequences/commands/accuracy_renderer.h"
#include "sequences/commands/motion/accuracy_predictive.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/warps/solver_report.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {
namespace {

int run_solver_accuracy(const AccuracyOptions& options, std::ostream& out) {
  if (options.inputs < 1 || options.inputs > 100000)
    throw InputError("--inputs " + std::to_string(options.inputs) + ", rule: 1 … 100000");
  const ProgressKind progress = choice("--progress", options.progress, kProgressWords);
  prepare_folder(options.out);
  const MeasuredSolvers solvers = measure_solvers(options.inputs, progress);
  write_report(solvers, options.out);
  print_report(solvers, out);
  out << "\nresults in " << options.out << "\n";
  return kSuccess;
}

}  // namespace

int run_accuracy(const AccuracyOptions& options, std::ostream& out) {
  const bool regulator = !options.regulator.sequence.empty(), renderer = !options.renderer.empty(),
             factoring = !options.factoring.empty(), predictive = !options.predictive.empty();
  const int experiments = options.solvers + options.hard + regulator + renderer + factoring + predictive;
  if (experiments != 1)
    throw InputError(
        "accuracy: " + std::string(experiments == 0 ? "nothing to measure" : "more than one experiment") +
        ", rule: one of --solvers, --hard, --regulator SEQUENCE, --renderer SEQUENCE, --factoring SEQUENCE, "
        "--predictive SEQUENCE");
  require_plotter();
  if (options.solvers) return run_solver_accuracy(options, out);
  if (options.hard)
    return run_hard_accuracy(options.out, choice("--progress", options.progress, kProgressWords), out);
  ExperimentOptions asked = options.regulator;
  asked.progress = options.progress;
  if (regulator) return run_regulator_accuracy(asked, options.out, out);
  asked.sequence = renderer ? options.renderer : predictive ? options.predictive : options.factoring;
  if (predictive) return run_predictive_accuracy(asked, options.out, out);
  return renderer ? run_renderer_accuracy(asked, options.out, out)
                  : run_factoring_accuracy(asked, options.out, out);
}

}  // namespace talisman::sequences
