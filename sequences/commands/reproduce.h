// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman reproduce`: what papers say beside what comes out here (experiments/reproduction/paper.h). The files are
/// those of experiments/reproduction/report.h.

#include <iosfwd>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace talisman::sequences {

struct ReproduceOptions {
  bool quick = false;             ///< no rows that draw pictures
  std::vector<std::string> only;  ///< tags, or TAG:ITEM; empty: all
  std::string out = "out/reproduce";
  std::string progress = "auto";  ///< auto, bar, plain or none
};

void add_reproduce_options(CLI::App& command, ReproduceOptions& options);

/// Returns kFailed where a row says no that must say yes, kPartialResult where one could not be measured. Throws
/// InputError and OutputError.
int run_reproduce(const ReproduceOptions& options, std::ostream& out);

}  // namespace talisman::sequences
