// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_amortised.h"

#include "sequences/experiments/amortised/measured.h"

namespace talisman::sequences {
namespace {

ResolvedRun amortised_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options), "threshold");
}

void require_amortised_frames(const Sequence& sequence, const ExperimentOptions& options) {
  experiment_frames(amortised_run(sequence, options), options.quality_every);
}

AmortisedExperiment measure_groupings(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = amortised_run(sequence, options);
  return measure_amortised(sequence, run.settings, experiment_frames(run, options.quality_every),
                           run.options.progress);
}

}  // namespace

int run_amortised_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<AmortisedExperiment> command{require_amortised_frames, measure_groupings};
  return run_experiment(command, options, dir, out);
}

}  // namespace talisman::sequences
