// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The command `report`: the page of a run, or of two beside each other.

#include <iosfwd>
#include <string>
#include <vector>

namespace talisman::sequences {

struct ReportOptions {
  std::vector<std::string> folders;  ///< one or two
  std::string out;                   ///< a file; empty: report.html in the first folder
  bool no_thumbnails = false;
};

/// Writes the page and says where. Throws InputError, OutputError.
int run_report(const ReportOptions& options, std::ostream& out);

}  // namespace talisman::sequences
