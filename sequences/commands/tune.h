// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman tune SEQUENCE|MODEL --flip X | --psnr X | --budget-ms X`: which thresholds are enough?

#include <atomic>
#include <iosfwd>
#include <optional>

#include "sequences/commands/options.h"

namespace CLI {
class App;
}

namespace talisman::sequences {

struct TuneOptions {
  CommandLine line;  ///< sequence, frames, size, policy, out, threads, progress, content
  std::optional<double> flip, psnr, budget_ms;
  bool mean = false;
};

void add_tune_options(CLI::App& command, TuneOptions& options);

/// Exit code 1 where no threshold holds the goal, 3 where `stop` was set before it was found. Throws InputError,
/// OutputError.
int run_tune(const TuneOptions& options, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
