// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/report_command.h"

#include <ostream>

#include "sequences/files/errors.h"
#include "sequences/results/report/report.h"

namespace talisman::sequences {

int run_report(const ReportOptions& options, std::ostream& out) {
  out << "wrote " << write_report(options.folders, options.out, !options.no_thumbnails) << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
