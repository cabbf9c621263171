// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman warps`: the experiments of [LS97 4.2] in one go.
///
/// First series: update rate against error threshold at 1024 × 1024, all fourteen curves; every object in the
/// main motion, and teapot and flat teapot (without them box and flat box) in all motions. Second series:
/// picture quality of those two at one equal update rate. Written to DIR:
///
///   warps.csv            object,motion,curve,threshold_px,renders,frames,update_rate
///   <object>-<motion>.svg and .csv, one figure each
///   quality.csv          object,curve,threshold_px,renders,frames,psnr_db,ssim,flip
///   warps.md, report.html  the figures, and how order and clusters compare with the paper's

#include <iosfwd>
#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

struct WarpsOptions {
  std::string object;             ///< name or file; empty: all
  std::string out = "out/warps";  ///< created where needed
  std::string bound =
      "box8";  ///< characteristic polyhedron: box8, dop14 (24 points) or dop26 (48); cost ~ points
  std::string progress = "auto";  ///< auto, bar, plain or none
};

/// Returns success, or kPartialResult when objects were left out because their content is not there; they
/// are named with the command that fetches it. Throws InputError and OutputError.
int run_warps(const WarpsOptions& options, std::ostream& out);

}  // namespace talisman::sequences
