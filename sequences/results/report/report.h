// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The report of a run, or of two beside each other: one HTML file that needs no network and no other file.
///
///   first look        what ran, the verdict in one sentence, a still with the outlines of its sprites; then layers,
///                     reasons and the worst decisions as tables. All of this is there without JavaScript.
///   the instrument    layers × frames as a map, curves, and one decision in full: page/*.js, from the packed columns
///
/// Every number in the page is one of the result files (report_run.h), or a sum over them.

#include <string>
#include <vector>

#include "sequences/results/report/report_run.h"

namespace talisman::sequences {

/// One or two runs. Throws OutputError where this build has no report.
std::string report_html(std::vector<ReportRun>& runs);

/// Reads the folders and writes the page of the first into its report.html, or to `file`. Returns the path.
std::string write_report(const std::vector<std::string>& folders, const std::string& file, bool thumbnails);

}  // namespace talisman::sequences
