// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What `talisman tune` says, and its files:
///
/// - tune.csv: one line per setting of the grid and per answer: threshold, cost, quality as far as it was measured
/// - tune.json: talisman.tune/1, the same and the thresholds of the layers
/// - tune-curve.svg, tune-curve.csv: quality against cost; for a budget of ms, time against threshold
/// - tune.html: all of it as a page
///
/// Quality of a setting that failed is a bound: of the frames that were drawn. All numbers are the same in every run.

#include <string>

#include "sequences/experiments/tuning/search.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// The lines to paste into the sequence's file.
std::string yaml_of(const TuneReport& report, const TunePoint& point);
std::string tune_csv(const TuneReport& report);
std::string json_of(const TuneReport& report);
Plot tune_plot(const TuneReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const TuneReport& report, const std::string& dir);
Page page_of(const TuneReport& report);

}  // namespace talisman::sequences
