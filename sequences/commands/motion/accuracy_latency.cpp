// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_latency.h"

#include <algorithm>
#include <ostream>

#include "sequences/content/value_type.h"
#include "sequences/experiments/latency/displayed.h"
#include "sequences/experiments/latency/latency_curve.h"

namespace talisman::sequences {

namespace {

/// Frames of which pictures are compared, unless it is said: each of them under 70 ways.
constexpr int kLatencySamples = 12;

}  // namespace

int run_latency_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const double warp_ms = options.warp_ms;
  if (!(warp_ms >= 0 && warp_ms <= 1000))
    throw InputError("--warp-ms is " + shown(warp_ms) + ", rule: from 0 to 1000");
  require_progress_word(options.progress);
  if (options.quality_every < 0)
    throw InputError("--quality-every is " + std::to_string(options.quality_every) +
                     ", must be at least 0 (0: automatic)");
  const Sequence sequence = load_with_warnings(options.sequence);
  const ResolvedRun run = experiment_run(sequence, options, experiment_size(sequence, options));
  // The longest latency, and the poses that a filter sees before it.
  const double history_s = kRenderLatencies_ms.back() / 1000 + kTrackedPoses * kTrackerStep_s;
  FrameRange frames{run.options.first_frame, run.options.last_frame};
  while (frames.first <= frames.last && frames.first / run.settings.fps < history_s) ++frames.first;
  if (frames.first > frames.last)
    throw InputError(sequence.name + ": no frame is later than " + shown(history_s) +
                     " s, rule: some are, since so much of the past is looked at");
  create_folder(dir);
  const LatencyCurve curve = measure_latency(sequence, run.settings, frames, warp_ms);
  publish(curve, dir, out);
  const int every = options.quality_every > 0
                        ? options.quality_every
                        : std::max(1, (frames.last - frames.first + kLatencySamples) / kLatencySamples);
  const DisplayedExperiment displayed = measure_displayed(
      sequence, run.settings, {frames.first, frames.last, every}, warp_ms, run.options.progress);
  out << "\n";
  publish(displayed, dir, out);
  out << "\nresults in " << dir << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
