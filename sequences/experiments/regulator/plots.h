// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The pictures of report.h: one series per policy, the oracle in black.

#include <string>
#include <vector>

#include "sequences/experiments/regulator/measured.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// By setting: nothing else draws as few polygons at as little FLIP.
std::vector<bool> polygon_front(const RegulatorReport& report);

Plot time_plot(const RegulatorReport& report);
Plot polygon_plot(const RegulatorReport& report);
Plot bound_plot(const RegulatorReport& report);
Plot popping_plot(const RegulatorReport& report);
Plot lookahead_plot(const LookaheadCurve& curve);
/// Entry `index` of RegulatorReport::calibration.
Plot calibration_plot(const RegulatorReport& report, std::size_t index);

/// All of them, as SVG and CSV. Throws OutputError.
void write_regulator_plots(const RegulatorReport& report, const std::string& dir);

}  // namespace talisman::sequences
