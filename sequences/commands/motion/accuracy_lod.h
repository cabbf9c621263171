// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --lod SEQUENCE`: what a level of detail buys
/// (experiments/lod/measured.h).

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"

namespace talisman::sequences {

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_lod_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
