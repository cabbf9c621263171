// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of `talisman accuracy --factoring`, as tables, CSV, JSON and pictures.
///
/// - factoring.csv: one line per picture of experiment.h, how far it is from the unfactored truth
/// - factoring-layers.csv: one line per factored layer, and one for the frame: predicted and measured error
/// - factoring-costs.csv: the factored sequence and the unfactored one
/// - factoring.json: talisman.factoring/1, all of it
/// - factoring.png: of the frame with the largest error: the frame both ways, the place of the largest error
///   enlarged, and maps of the measured error, of the predicted one, and of their difference; the maps also
///   as factoring-measured.png, factoring-predicted.png, factoring-difference.png
/// - factoring-prediction.svg: measured against predicted error
/// - factoring-losses.svg: the loss of every picture, frame by frame
/// - factoring.html: all of it as a page
///
/// Beside each SVG lies a CSV with the points that it shows. Columns named `wall_…` are measured times; all
/// else is the same in every run.

#include <string>

#include "sequences/experiments/factoring/measured.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

std::string pictures_csv(const FactoringReport& report);
std::string layers_csv(const FactoringReport& report);
std::string costs_csv(const FactoringReport& report);
std::string json_of(const FactoringReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const FactoringReport& report, const std::string& dir);

Page page_of(const FactoringReport& report);

}  // namespace talisman::sequences
