// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_factoring.h"

#include "sequences/experiments/factoring/experiment.h"
#include "sequences/experiments/factoring/variants.h"

namespace talisman::sequences {
namespace {

ResolvedRun factoring_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options));
}

void require_factored(const Sequence& sequence, const ExperimentOptions& options) {
  if (!is_factored(sequence))
    throw InputError(
        sequence.name +
        ": no layer factors a shade term, rule: some layer has `shading` that the scene calls for");
  experiment_frames(factoring_run(sequence, options), options.quality_every);
}

}  // namespace

FactoringReport measure_factoring_report(const Sequence& sequence, const ExperimentOptions& options) {
  require_factored(sequence, options);
  const ResolvedRun run = factoring_run(sequence, options);
  FactoringReport report;
  report.sequence = sequence.name;
  report.given = run.settings;
  report.policy = regulator::name(run.settings.regulator.policy);
  report.warp = warp::name(run.settings.curve);
  report.display_px = run.settings.view.display_px;
  report.frames = experiment_frames(run, options.quality_every);
  report.result = measure_factoring({sequence, run.settings}, report.frames, run.options.progress);
  return report;
}

int run_factoring_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<FactoringReport> command{require_factored, measure_factoring_report};
  return run_experiment(command, options, dir, out);
}

}  // namespace talisman::sequences
