// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --culling SEQUENCE`: which structure finds what is in view in the least time
/// (experiments/culling/measured.h). `--visibility SEQUENCE`: what each triple of tests leaves and costs
/// (experiments/culling/visibility.h). `--memory SEQUENCE`: how far ahead is best read what may be seen
/// (experiments/memory/measured.h).

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"

namespace talisman::sequences {

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_culling_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

/// Likewise. Exit code 1 where a picture differs.
int run_visibility_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

/// Likewise. Without a size it is that of [Fu93]'s display, 1280x1024: nothing is drawn.
int run_memory_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
