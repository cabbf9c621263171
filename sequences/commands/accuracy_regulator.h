// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --regulator SEQUENCE`: what accuracy costs in time for the whole pipeline, how hard the
/// picture pops, what knowing the motion ahead saves, and what a fiducial says about the picture. The files
/// are those of regulator_report.h.

#include <iosfwd>
#include <string>

#include "sequences/commands/options.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/report.h"

namespace talisman::sequences {

struct RegulatorCommandOptions {
  std::string sequence;   ///< name or path, as of `render`; empty: not asked for
  std::string frames;     ///< "A-B", inclusive; empty: all
  std::string size;       ///< "WxH"; empty: the sequence's, scaled down to kLargestDefaultPx
  int quality_every = 0;  ///< ≥ 1: one frame of so many is drawn and compared, cost in proportion to its
                          ///< inverse; 0: so that about kDefaultSamples are
  std::string progress = "auto";  ///< auto, bar, plain or none
};

/// With these the canyon takes about three minutes on two cores.
inline constexpr int kLargestDefaultPx = 512;
inline constexpr int kDefaultSamples = 20;

/// The display made smaller in both directions until its larger side is kLargestDefaultPx, as "WxH".
std::string default_experiment_size(layers::ivec2 display_px);

/// The frames of the run, one in `every` to be drawn; 0: so that about kDefaultSamples are. Throws
/// InputError.
ExperimentFrames experiment_frames(const ResolvedRun& run, int every);

/// All measurements. `options.sequence` is already read. Throws InputError.
RegulatorReport measure_regulator_report(const Sequence& sequence, const RegulatorCommandOptions& options);

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_regulator_accuracy(const RegulatorCommandOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
