// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/report_command.h"

#include <ostream>

#include "sequences/files/errors.h"
#include "sequences/results/report/report.h"

namespace talisman::sequences {

int run_report(const ReportOptions& options, std::ostream& out) {
  const std::string file = write_report(options.folders, options.out, !options.no_thumbnails);
  out << "wrote " << file << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
