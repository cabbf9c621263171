// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of `talisman warps`, as tables, CSV, figures and a page.
///
/// - warps.csv: object,motion,curve,threshold_px,renders,frames,update_rate
/// - OBJECT-MOTION.svg and .csv: one figure each
/// - quality.csv: object,curve,threshold_px,renders,frames,psnr_db,ssim,flip
/// - warps.md, report.html: the figures, and how order and clusters compare with the paper's
///
/// All of it is the same in every run.

#include <iosfwd>
#include <string>

#include "sequences/experiments/warps/measured.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const WarpReport& report, const std::string& dir);

/// Update rate against error threshold, in the axes of the paper's figures.
Plot update_rate_plot(const std::string& title, const std::vector<double>& thresholds_px,
                      const std::vector<UpdateCurve>& curves);

void print_report(const WarpReport& report, std::ostream& out);

}  // namespace talisman::sequences
