// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_hard.h"

#include <ostream>

#include "sequences/experiments/hard/report.h"
#include "sequences/experiments/published.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"

namespace talisman::sequences {

int run_hard_accuracy(const std::string& dir, ProgressKind progress, std::ostream& out) {
  prepare_folder(dir);
  const HardReport report = measure_hard_report(progress);
  publish(report, dir, out);
  out << "\nresults in " << dir << "\n";
  return broken_cases(report) == 0 ? kSuccess : kFailed;
}

}  // namespace talisman::sequences
