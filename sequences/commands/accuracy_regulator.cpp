// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_regulator.h"

#include "sequences/experiments/regulator/experiment.h"
#include "sequences/experiments/regulator/stored_runs.h"

namespace talisman::sequences {
namespace {

/// Any policy that needs no more options: the settings that are compared have their own.
constexpr const char* kPolicy = "threshold";

ResolvedRun regulator_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options), kPolicy);
}

void require_regulator_frames(const Sequence& sequence, const ExperimentOptions& options) {
  experiment_frames(regulator_run(sequence, options), options.quality_every);
}

}  // namespace

RegulatorReport measure_regulator_report(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = regulator_run(sequence, options);
  const ProgressKind progress = run.options.progress;
  RegulatorReport report;
  report.sequence = sequence.name;
  report.given = run.settings;
  report.warp = warp::name(run.settings.curve);
  report.display_px = run.settings.view.display_px;
  report.frames = experiment_frames(run, options.quality_every);
  for (const layers::Layer& layer : sequence.layers.layers) report.layers.push_back(layer.name);
  const double polygons = reference_polygons_per_frame(sequence, run.settings, report.frames);
  report.settings = measure_regulator(
      sequence, run.settings, regulator_settings(run.settings.regulator, polygons), report.frames, progress);
  // Plans cost nothing: at the display for which the sequence's own threshold is meant.
  const ResolvedRun planned = experiment_run(sequence, options, options.size, kPolicy);
  report.lookahead = lookahead_curve(sequence, planned.settings, report.frames);
  report.samples = calibration_samples(sequence, run.settings, sampled_frames(report.frames), progress);
  report.calibration = summarize_calibration(report.samples);
  return report;
}

int run_regulator_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<RegulatorReport> command{require_regulator_frames, measure_regulator_report,
                                                   options.no_report ? nullptr : store_runs};
  return run_experiment(command, options, dir, out);
}

}  // namespace talisman::sequences
