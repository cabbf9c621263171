// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --factoring SEQUENCE`: what it costs that the compositor has only `over`, and what
/// factoring saves. The files are those of experiments/factoring/report.h.

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"
#include "sequences/experiments/factoring/report.h"

namespace talisman::sequences {

/// All measurements, under the sequence's own policy. `options.sequence` is already read. Throws InputError,
/// also when no layer factors a shade term.
FactoringReport measure_factoring_report(const Sequence& sequence, const ExperimentOptions& options);

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_factoring_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
