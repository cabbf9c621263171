// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_renderer.h"

#include <algorithm>
#include <numeric>

#include "sequences/experiments/renderer/experiment.h"

namespace talisman::sequences {
namespace {

ResolvedRun renderer_run(const Sequence& sequence, const ExperimentOptions& options) {
  return experiment_run(sequence, options, experiment_size(sequence, options));
}

ExperimentFrames drawn_from_nothing(const ResolvedRun& run, const ExperimentOptions& options) {
  return experiment_frames(run, options.quality_every, kDefaultRendererSamples);
}

std::vector<int> frames_of_run(const ResolvedRun& run, bool is_given) {
  const int all = run.options.last_frame - run.options.first_frame + 1;
  std::vector<int> frames(is_given ? all : std::min(all, kDefaultRun_frames));
  std::iota(frames.begin(), frames.end(), run.options.first_frame);
  return frames;
}

void require_renderer_frames(const Sequence& sequence, const ExperimentOptions& options) {
  drawn_from_nothing(renderer_run(sequence, options), options);
}

}  // namespace

RendererReport measure_renderer_report(const Sequence& sequence, const ExperimentOptions& options) {
  const ResolvedRun run = renderer_run(sequence, options);
  const Variant given{sequence, run.settings};
  const std::vector<int> frames = sampled_frames(drawn_from_nothing(run, options));
  RendererReport report;
  report.sequence = sequence.name;
  report.given = run.settings;
  report.display_px = run.settings.view.display_px;
  report.rounds = kRendererRounds;
  report.policy = regulator::name(run.settings.regulator.policy);
  report.knobs = measure_knobs(given, frames, kRendererRounds, run.options.progress);
  report.effects = measure_effects(given, frames, frames_of_run(run, !options.frames.empty()),
                                   kRendererRounds, run.options.progress);
  return report;
}

int run_renderer_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const ExperimentCommand<RendererReport> command{require_renderer_frames, measure_renderer_report};
  return run_experiment(command, options, dir, out);
}

}  // namespace talisman::sequences
