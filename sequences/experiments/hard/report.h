// SPDX-License-Identifier: Apache-2.0
#pragma once

/// All hard cases (hard_case.h) in one table, and what the width of numbers does (number_width.h).
///
/// - hard.csv: one line per case: stage, case, special, extreme, rule, unit, oracle, to be refused, error, status
/// - hard-cases.svg: the error of each case as a share of its rule, over how extreme it is
/// - hard-fit.svg, hard-projection.svg: error over scale for float and double
///
/// The same bytes in every run. Each plot has its points beside it as CSV.

#include <string>
#include <vector>

#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/hard/number_width.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

struct HardReport {
  std::vector<MeasuredHardCase> cases;
  WidthCurves widths;
};

/// Cost: a few seconds.
HardReport measure_hard_report(ProgressKind progress);

/// Those whose rule is broken.
int broken_cases(const HardReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const HardReport& report, const std::string& dir);

/// A table per stage, and how many hold (published.h).
Page page_of(const HardReport& report);

}  // namespace talisman::sequences
