// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy.h"

#include <ostream>

#include "sequences/commands/accuracy_factoring.h"
#include "sequences/commands/accuracy_hard.h"
#include "sequences/commands/accuracy_regulator.h"
#include "sequences/commands/accuracy_renderer.h"
#include "sequences/commands/culling/accuracy_culling.h"
#include "sequences/commands/motion/accuracy_amortised.h"
#include "sequences/commands/motion/accuracy_latency.h"
#include "sequences/commands/motion/accuracy_lod.h"
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
  publish(solvers, options.out, out);
  out << "\nresults in " << options.out << "\n";
  return kSuccess;
}

/// An experiment on a sequence.
struct SequenceExperiment {
  const char* option;
  std::string AccuracyOptions::*sequence;
  int (*run)(const ExperimentOptions&, const std::string&, std::ostream&);
};
constexpr SequenceExperiment kSequenceExperiments[] = {
    {"--regulator", &AccuracyOptions::regulator, run_regulator_accuracy},
    {"--renderer", &AccuracyOptions::renderer, run_renderer_accuracy},
    {"--factoring", &AccuracyOptions::factoring, run_factoring_accuracy},
    {"--predictive", &AccuracyOptions::predictive, run_predictive_accuracy},
    {"--amortised", &AccuracyOptions::amortised, run_amortised_accuracy},
    {"--latency", &AccuracyOptions::latency, run_latency_accuracy},
    {"--lod", &AccuracyOptions::lod, run_lod_accuracy},
    {"--culling", &AccuracyOptions::culling, run_culling_accuracy},
    {"--visibility", &AccuracyOptions::visibility, run_visibility_accuracy},
    {"--memory", &AccuracyOptions::memory, run_memory_accuracy},
};

/// The one experiment that is asked for; null: --solvers or --hard.
const SequenceExperiment* chosen_experiment(const AccuracyOptions& options) {
  const SequenceExperiment* chosen = nullptr;
  int experiments = options.solvers + options.hard;
  std::string known = "--solvers, --hard";
  for (const SequenceExperiment& experiment : kSequenceExperiments) {
    known += std::string(", ") + experiment.option + " SEQUENCE";
    if ((options.*experiment.sequence).empty()) continue;
    chosen = &experiment;
    ++experiments;
  }
  if (experiments != 1)
    throw InputError(
        "accuracy: " + std::string(experiments == 0 ? "nothing to measure" : "more than one experiment") +
        ", rule: one of " + known);
  return chosen;
}

}  // namespace

int run_accuracy(const AccuracyOptions& options, std::ostream& out) {
  const SequenceExperiment* experiment = chosen_experiment(options);
  if (options.of_sequence.warp_ms != 0 && options.latency.empty())
    throw InputError("--warp-ms is about the last warp of --latency, must come with it");
  if ((options.of_sequence.memory_mb || options.of_sequence.io_mb_per_s) && options.memory.empty())
    throw InputError("--memory-mb and --io-mb-per-s are limits of --memory, must come with it");
  if (options.of_sequence.no_report && options.regulator.empty())
    throw InputError("--no-report is about the runs behind --regulator, must come with it");
  require_plotter();
  if (options.solvers) return run_solver_accuracy(options, out);
  if (options.hard)
    return run_hard_accuracy(options.out, choice("--progress", options.progress, kProgressWords), out);
  ExperimentOptions asked = options.of_sequence;
  asked.sequence = options.*experiment->sequence;
  asked.progress = options.progress;
  return experiment->run(asked, options.out, out);
}

}  // namespace talisman::sequences
