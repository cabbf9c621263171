// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/culling/accuracy_culling.h"

#include <algorithm>

#include "sequences/experiments/culling/measured.h"
#include "sequences/experiments/culling/visibility.h"

namespace talisman::sequences {
namespace {

ResolvedRun culling_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options), "direct");
}

void require_culling_frames(const Sequence& sequence, const ExperimentOptions& options) {
  if (sequence.scene->parts.empty()) throw InputError(sequence.name + ": no parts, rule: at least one");
  experiment_frames(culling_run(sequence, options), options.quality_every);
}

CullingExperiment measure_culling_of(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = culling_run(sequence, options);
  return measure_culling(sequence, run.settings, experiment_frames(run, options.quality_every),
                         run.options.progress);
}

VisibilityExperiment measure_visibility_of(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = culling_run(sequence, options);
  return measure_visibility(sequence, run.settings, experiment_frames(run, options.quality_every),
                            run.options.progress);
}

}  // namespace

int run_culling_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<CullingExperiment> command{require_culling_frames, measure_culling_of};
  return run_experiment(command, options, dir, out);
}

int run_visibility_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  require_progress_word(options.progress);
  const Sequence sequence = load_with_warnings(options.sequence);
  require_culling_frames(sequence, options);
  create_folder(dir);
  const VisibilityExperiment experiment = measure_visibility_of(sequence, options);
  write_report(experiment, dir);
  print_report(experiment, out);
  out << "\nresults in " << dir << "\n";
  const bool differs = std::any_of(experiment.results.begin(), experiment.results.end(),
                                   [](const VisibilityResult& r) { return r.differing > 0; });
  return differs ? kFailed : kSuccess;
}

}  // namespace talisman::sequences
