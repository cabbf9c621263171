// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of `talisman accuracy --regulator`, as tables, CSV, JSON and pictures.
///
/// - regulator.csv: one line per setting, what was drawn, what it cost, how far it is from the truth
/// - regulator.svg: FLIP against measured time per frame; the Pareto front is marked
/// - regulator-polygons.svg: FLIP against polygons drawn, the same without the noise of a clock
/// - regulator-bound.svg: largest geometric error displayed against renders; the oracle is the floor of renders
/// - regulator-popping.svg: step of the error at a re-render against polygons drawn (popping.h)
/// - lookahead.csv, lookahead.svg: renders against N of lookahead, between threshold and oracle
/// - calibration.csv: one line per sample, fiducials and image error (calibration.h)
/// - calibration-NAME.svg: image error against one fiducial, with the medians of its octaves
/// - regulator.json: talisman.regulator/1, all of it but the samples
/// - regulator.html: all of it as a page, in which a point opens its run (stored_runs.h)
///
/// Beside each SVG lies a CSV with the points that it shows. Columns named `wall_…` are measured times; all
/// else is the same in every run. The oracle is a floor of renders alone: it counts a small sprite and a large one
/// alike, and may take more polygons or pixels than another schedule. Popping is missing ('-', null) where no sprite
/// was drawn again in the frames that were compared.

#include <string>

#include "sequences/experiments/regulator/measured.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

std::string settings_csv(const RegulatorReport& report);
std::string samples_csv(const RegulatorReport& report);
std::string json_of(const RegulatorReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const RegulatorReport& report, const std::string& dir);

Page page_of(const RegulatorReport& report);

}  // namespace talisman::sequences
