// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman warps`: the experiments of [LS97 4.2] in one go, on every object or on one
/// (experiments/warps/experiment.h). The files are those of experiments/warps/report.h.

#include <iosfwd>
#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

struct WarpsOptions {
  std::string object;             ///< name or file; empty: all
  std::string out = "out/warps";  ///< created where needed
  /// Characteristic polyhedron: box8, dop14 (24 points) or dop26 (48); cost ~ points.
  std::string bound = "box8";
  std::string progress = "auto";  ///< auto, bar, plain or none
};

/// Returns success, or kPartialResult when objects were left out because their content is not there; they
/// are named with the command that fetches it. Throws InputError and OutputError.
int run_warps(const WarpsOptions& options, std::ostream& out);

}  // namespace talisman::sequences
