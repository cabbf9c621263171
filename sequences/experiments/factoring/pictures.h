// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Maps, sheet and plots of report.h.
///
/// A map shows the luminance of a signed error in linear light: white is none, red too bright, blue too dark,
/// with full colour at a round number of per cent of white that is at least the largest predicted error; a
/// bar in the map says so. The difference map shows a tenth of that range.

#include "sequences/experiments/factoring/measured.h"
#include "sequences/pictures/image_drawing.h"
#include "sequences/pictures/picture_sheet.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

enum class ErrorMap { Measured, Predicted, Difference };

/// The smallest of 1, 2, 5 · 10ⁿ that is not below `value`; 1e-4 at least.
double round_up_125(double value);

/// Full colour at an error of ± `full`.
Image8 error_map(const ShownFrame& frame, ErrorMap map, double full);

/// All in one.
Image8 factoring_sheet(const FactoringReport& report);

Plot prediction_plot(const FactoringReport& report);
Plot losses_plot(const FactoringReport& report);

/// All of them, as PNG, SVG and CSV. Throws OutputError.
void write_factoring_pictures(const FactoringReport& report, const std::string& dir);

}  // namespace talisman::sequences
