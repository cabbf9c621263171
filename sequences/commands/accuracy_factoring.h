// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --factoring SEQUENCE`: what it costs that the compositor has only `over`, and what
/// factoring saves. The files are those of factoring_report.h.

#include <iosfwd>
#include <string>

#include "sequences/commands/accuracy_regulator.h"
#include "sequences/experiments/factoring/report.h"

namespace talisman::sequences {

/// All measurements, under the sequence's own policy. `options.sequence` is already read. Throws InputError,
/// also when no layer factors a shade term.
FactoringReport measure_factoring_report(const Sequence& sequence, const RegulatorCommandOptions& options);

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_factoring_accuracy(const RegulatorCommandOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
