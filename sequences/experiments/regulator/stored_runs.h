// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What lies behind a point of the ladder? Each setting is planned once more, alone, and its report (results/report)
/// is kept: every decision with its reason. Its counts are those of the point.
///
/// Cost: one plan per setting, no pixel. A report takes 0.3 MB, and about 200 bytes more for each layer and frame: 0.8 MB of a
/// canyon of 250 frames.

#include <string>

#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/measured.h"

namespace talisman::sequences {

/// Writes DIR/runs/threshold-4-px.html, …, one report for each of `report.settings`, and notes them there. Nothing in a build without reports.
/// Throws OutputError.
void store_runs(const Sequence& sequence, RegulatorReport& report, const std::string& dir);

}  // namespace talisman::sequences
