// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_predictive.h"

#include "sequences/experiments/predictive/measured.h"

namespace talisman::sequences {
namespace {

ResolvedRun predictive_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options), "predictive");
}

void require_predictive_frames(const Sequence& sequence, const ExperimentOptions& options) {
  experiment_frames(predictive_run(sequence, options), options.quality_every);
}

PredictiveExperiment measure(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = predictive_run(sequence, options);
  return measure_predictive(sequence, run.settings, experiment_frames(run, options.quality_every),
                            run.options.progress);
}

}  // namespace

int run_predictive_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<PredictiveExperiment> command{require_predictive_frames, measure};
  return run_experiment(command, options, dir, out);
}

}  // namespace talisman::sequences
