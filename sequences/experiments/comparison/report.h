// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman compare` says, and its files:
///
/// - compare.csv: one line per setting
/// - compare.json: talisman.compare/1, the same
/// - runs/NAME.summary.json, runs/NAME.frames.jsonl: of each setting what a run of its own writes
/// - compare-cost.svg: FLIP against modelled time; compare-frames.svg: FLIP over the frames; beside each a CSV
/// - compare.html: all of it as a page
///
/// Columns named `wall_…` are measured times; all else is the same in every run.

#include <string>

#include "sequences/experiments/comparison/comparison.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

std::string compare_csv(const ComparisonReport& report);
std::string json_of(const ComparisonReport& report);
Plot cost_plot(const ComparisonReport& report);
Plot frames_plot(const ComparisonReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const ComparisonReport& report, const std::string& dir);
Page page_of(const ComparisonReport& report);

}  // namespace talisman::sequences
