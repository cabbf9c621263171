// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman compare` says, and its files:
///
/// - compare.csv: one line per setting
/// - compare.json: talisman.compare/1, the same
/// - runs/NAME.summary.json, runs/NAME.frames.jsonl: of each setting what a run of its own writes
/// - compare-cost.svg: FLIP against modelled time; compare-frames.svg: FLIP over the frames; beside each a CSV
///
/// Columns named `wall_…` are measured times; all else is the same in every run.

#include <iosfwd>
#include <string>

#include "sequences/experiments/comparison/comparison.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

std::string compare_csv(const ComparisonReport& report);
std::string json_of(const ComparisonReport& report);
Plot cost_plot(const ComparisonReport& report);
Plot frames_plot(const ComparisonReport& report);

/// "budget-ms-5" of "budget:ms=5": what a file may be called.
std::string file_name_of(const std::string& setting);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const ComparisonReport& report, const std::string& dir);
void print_report(const ComparisonReport& report, std::ostream& out);

}  // namespace talisman::sequences
