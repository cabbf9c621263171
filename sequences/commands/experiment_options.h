// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the commands of the experiments on sequences have in common: their options, and the steps from a name
/// on the command line to files in a folder.

#include <optional>
#include <ostream>
#include <string>

#include "sequences/commands/options.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/published.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/progress.h"
#include "sequences/results/run.h"

namespace talisman::sequences {

struct ExperimentOptions {
  std::string sequence;   ///< name or path, as of `render`; empty: not asked for
  std::string frames;     ///< "A-B", inclusive; empty: all
  std::string size;       ///< "WxH"; empty: the sequence's, scaled down to kLargestDefault_px
  int quality_every = 0;  ///< ≥ 1: one frame of so many is drawn and compared, cost in proportion to its
                          ///< inverse; 0: so that about kDefaultSamples are
  std::string progress = "auto";  ///< auto, bar, plain or none
  bool no_report = false;         ///< of regulator alone: no page for each run that was measured
  double warp_ms = 0;             ///< of latency alone: age of the pose of the last warp, 0 … 1000
  // Of memory alone; empty: those of [Fu93].
  std::optional<double> memory_mb = {}, io_mb_per_s = {};  ///< ≥ 0
};

/// With these the canyon takes about three minutes on two cores.
inline constexpr int kLargestDefault_px = 512;
inline constexpr int kDefaultSamples = 20;

/// "WxH" as given, else the sequence's display made smaller in both directions until its larger side is
/// kLargestDefault_px.
std::string experiment_size(const Sequence& sequence, const ExperimentOptions& options);

/// What `plan` would make of the options on a display of `size` (empty: the sequence's); `policy` empty: the
/// sequence's own. Throws InputError.
ResolvedRun experiment_run(const Sequence& sequence, const ExperimentOptions& options,
                           const std::string& size, const std::string& policy = "");

/// The frames of the run, one in `every` to be drawn; 0: so that about `samples` are. Throws InputError.
ExperimentFrames experiment_frames(const ResolvedRun& run, int every, int samples = kDefaultSamples);

/// Throws InputError unless it is one of the words of --progress.
void require_progress_word(const std::string& word);

/// What makes one experiment out of the steps that all of them take.
template <typename Report>
struct ExperimentCommand {
  /// Throws InputError where the sequence, or an option, allows no measurement.
  void (*require)(const Sequence&, const ExperimentOptions&);
  Report (*measure)(const Sequence&, const ExperimentOptions&);
  /// Null, or leaves more in the folder than the report, and notes it there.
  void (*store)(const Sequence&, Report&, const std::string& dir) = nullptr;
};

/// Reads the sequence, measures, and publishes into the folder `dir` (experiments/published.h). What
/// can be refused is refused before the sequence is read or the folder made. Throws InputError and
/// OutputError.
template <typename Report>
int run_experiment(const ExperimentCommand<Report>& command, const ExperimentOptions& options,
                   const std::string& dir, std::ostream& out) {
  require_progress_word(options.progress);
  const Sequence sequence = load_with_warnings(options.sequence);
  command.require(sequence, options);
  create_folder(dir);
  Report report = command.measure(sequence, options);
  if (command.store) command.store(sequence, report, dir);
  publish(report, dir, out);
  out << "\nresults in " << dir << "\n";
  return kSuccess;
}

/// The same for what measures the frames of a sequence under one policy: measure(sequence, settings, frames, progress).
/// Returns its report.
template <typename Measure>
auto run_policy_experiment(const char* policy, const Measure& measure, const ExperimentOptions& options,
                           const std::string& dir, std::ostream& out) {
  require_progress_word(options.progress);
  const Sequence sequence = load_with_warnings(options.sequence);
  const ResolvedRun run = experiment_run(sequence, options, experiment_size(sequence, options), policy);
  const ExperimentFrames frames = experiment_frames(run, options.quality_every);
  create_folder(dir);
  auto report = measure(sequence, run.settings, frames, run.options.progress);
  publish(report, dir, out);
  out << "\nresults in " << dir << "\n";
  return report;
}

}  // namespace talisman::sequences
