// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman compare SEQUENCE|MODEL SETTING…`: several policies on the same frames, side by side.

#include <atomic>
#include <iosfwd>
#include <string>
#include <vector>

#include "sequences/commands/options.h"

namespace CLI {
class App;
}

namespace talisman::sequences {

struct CompareOptions {
  CommandLine line;  ///< sequence, frames, size, out, threads, progress, content
  std::vector<std::string> settings;
  bool no_video = false;
};

void add_compare_options(CLI::App& command, CompareOptions& options);

/// Exit code 3 where `stop` was set before the last frame: the tables hold the frames until then. Throws InputError,
/// OutputError.
int run_compare(const CompareOptions& options, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
