// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_regulator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "sequences/commands/experiment_options.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {
namespace {

/// Options as `render` would take them; the policy is any that needs no more of them.
ResolvedRun resolved(const Sequence& sequence, const RegulatorCommandOptions& options,
                     const std::string& size) {
  CommandLine line;
  line.policy = "threshold";
  line.frames = options.frames;
  line.size = size;
  line.progress = options.progress;
  return resolve(line, sequence, true);
}

}  // namespace

ExperimentFrames experiment_frames(const ResolvedRun& run, int every) {
  if (every < 0)
    throw InputError("--quality-every is " + std::to_string(every) + ", must be at least 0 (0: automatic)");
  const int frames = run.options.last_frame - run.options.first_frame + 1;
  if (every == 0) every = std::max(1, (frames + kDefaultSamples - 1) / kDefaultSamples);
  return {run.options.first_frame, run.options.last_frame, every};
}

std::string default_experiment_size(layers::ivec2 display_px) {
  const double scale = std::min(1.0, double(kLargestDefaultPx) / std::max(display_px.x, display_px.y));
  const auto scaled = [scale](int side) { return std::to_string(std::max(1L, std::lround(side * scale))); };
  return scaled(display_px.x) + "x" + scaled(display_px.y);
}

RegulatorReport measure_regulator_report(const Sequence& sequence, const RegulatorCommandOptions& options) {
  const ResolvedRun run = resolved(
      sequence, options, options.size.empty() ? default_experiment_size(sequence.display_px) : options.size);
  const ProgressKind progress = run.options.progress;
  RegulatorReport report;
  report.sequence = sequence.name;
  report.warp = warp::name(run.settings.curve);
  report.display_px = run.settings.view.display_px;
  report.frames = experiment_frames(run, options.quality_every);
  for (const layers::Layer& layer : sequence.layers.layers) report.layers.push_back(layer.name);
  const double polygons = reference_polygons_per_frame(sequence, run.settings, report.frames);
  report.settings = measure_regulator(
      sequence, run.settings, regulator_settings(run.settings.regulator, polygons), report.frames, progress);
  // Plans cost nothing: at the display for which the sequence's own threshold is meant.
  report.lookahead =
      lookahead_curve(sequence, resolved(sequence, options, options.size).settings, report.frames);
  report.samples = calibration_samples(sequence, run.settings, sampled_frames(report.frames), progress);
  report.calibration = summarize_calibration(report.samples);
  return report;
}

int run_regulator_accuracy(const RegulatorCommandOptions& options, const std::string& dir,
                           std::ostream& out) {
  progress_kind_from(options.progress);
  const Sequence sequence = load_sequence(options.sequence);
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  create_folder(dir);
  const RegulatorReport report = measure_regulator_report(sequence, options);
  write_report(report, dir);
  print_report(report, out);
  out << "\nresults in " << dir << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
