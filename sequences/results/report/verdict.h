// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A run in words.

#include <string>

#include "sequences/results/report/report_run.h"

namespace talisman::sequences {

/// "render of carousel, frames 0 to 47, 480 × 360 px, policy threshold at 1 px, warp aff".
std::string what_ran(const ReportRun& run);

/// One sentence: what was drawn against `reference`, the largest error of a fiducial, and that of the picture where it
/// was measured.
std::string verdict_on(const ReportRun& run);

/// "plan 0.008 s, render 1.2 s": with a clock, on one machine. Empty: nothing was measured.
std::string measured_times(const ReportRun& run);

}  // namespace talisman::sequences
