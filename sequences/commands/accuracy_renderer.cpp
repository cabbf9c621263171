// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_renderer.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <ostream>

#include "sequences/commands/experiment_options.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {
namespace {

ResolvedRun resolved(const Sequence& sequence, const RegulatorCommandOptions& options) {
  CommandLine line;
  line.frames = options.frames;
  line.size = options.size.empty() ? default_experiment_size(sequence.display_px) : options.size;
  line.progress = options.progress;
  return resolve(line, sequence, true);
}

std::vector<int> frames_from_nothing(const ResolvedRun& run, int every) {
  if (every < 0)
    throw InputError("--quality-every is " + std::to_string(every) + ", must be at least 0 (0: automatic)");
  const int frames = run.options.last_frame - run.options.first_frame + 1;
  if (every == 0) every = (frames + kDefaultRendererSamples - 1) / kDefaultRendererSamples;
  return sampled_frames({run.options.first_frame, run.options.last_frame, every});
}

std::vector<int> frames_of_run(const ResolvedRun& run, bool is_given) {
  const int all = run.options.last_frame - run.options.first_frame + 1;
  std::vector<int> frames(is_given ? all : std::min(all, kDefaultRunFrames));
  std::iota(frames.begin(), frames.end(), run.options.first_frame);
  return frames;
}

}  // namespace

RendererReport measure_renderer_report(const Sequence& sequence, const RegulatorCommandOptions& options) {
  const ResolvedRun run = resolved(sequence, options);
  const Variant given{sequence, run.settings};
  const std::vector<int> frames = frames_from_nothing(run, options.quality_every);
  RendererReport report;
  report.sequence = sequence.name;
  report.display_px = run.settings.view.display_px;
  report.rounds = kRendererRounds;
  report.policy = regulator::name(run.settings.regulator.policy);
  report.knobs = measure_knobs(given, frames, kRendererRounds, run.options.progress);
  report.effects = measure_effects(given, frames, frames_of_run(run, !options.frames.empty()),
                                   kRendererRounds, run.options.progress);
  return report;
}

int run_renderer_accuracy(const RegulatorCommandOptions& options, const std::string& dir, std::ostream& out) {
  progress_kind_from(options.progress);
  const Sequence sequence = load_sequence(options.sequence);
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  create_folder(dir);
  const RendererReport report = measure_renderer_report(sequence, options);
  write_report(report, dir);
  print_report(report, out);
  out << "\nresults in " << dir << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
