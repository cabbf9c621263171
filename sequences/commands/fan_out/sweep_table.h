// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What came of a sweep: OUT/sweep.csv, one row per job, and OUT/pareto.svg (with pareto.csv), error over cost.
///
///   job, sequence, options    of the sweep
///   status                    done, failed (it said why), missing (it was not run, or is not through)
///   why                       empty where it is done
///   mean_geometric_px         error of what is displayed, mean over layers and frames in which they are shown
///   max_geometric_px          the largest
///   then the columns of the table `run` (docs/outputs.md)
///
/// Jobs that were run in shards are merged first.

#include <string>

#include "sequences/commands/fan_out/sweep.h"

namespace talisman::sequences {

struct SweepOutcome {
  std::size_t done = 0, failed = 0, missing = 0;
  std::string without_plot;  ///< why there is none; empty: there is
};

/// Throws InputError and OutputError.
SweepOutcome write_sweep_table(const Sweep& sweep);

}  // namespace talisman::sequences
