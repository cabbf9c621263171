// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --regulator SEQUENCE`: what accuracy costs in time for the whole pipeline, how hard the
/// picture pops, what knowing the motion ahead saves, and what a fiducial says about the picture. The files
/// are those of experiments/regulator/report.h.

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"
#include "sequences/experiments/regulator/report.h"

namespace talisman::sequences {

/// All measurements. `options.sequence` is already read. Throws InputError.
RegulatorReport measure_regulator_report(const Sequence& sequence, const ExperimentOptions& options);

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_regulator_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
