// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman farm`: runs in parts, and sweeps, under the queue that a cluster has. Nothing is submitted here.
///
///   farm slurm SEQUENCE --shards N [OPTIONS]         a script that submits a job array of N shards and their merge
///        … --by-cost                                 and, before them, the plan by whose costs the shards are cut
///   farm slurm --sweep FILE [--shards N]             the same for the jobs of a sweep (sweep.h), and their table
///   farm list --sweep FILE                           the manifest: a line per task, "TASK<TAB>talisman …"
///   farm run --sweep FILE --task T                   one task; a job that is complete is left as it is
///   farm table --sweep FILE                          collects (sweep_table.h); exit code 3 where jobs failed or are missing
///
/// The merge depends on the array by afterany: it runs when all tasks ended, however they did, and says which are missing.

#include <atomic>
#include <iosfwd>
#include <string>
#include <vector>

#include "sequences/commands/options.h"

namespace talisman::sequences {

struct FarmOptions {
  std::string action;  ///< slurm, list, run, table
  std::string sequence;
  std::vector<std::string> options;  ///< of its run: all that is none of farm
  std::string sweep, out, command = "render";
  bool by_cost = false;         ///< shards are ranges that cost the same, by a plan that is made before them
  int shards = 1, at_most = 0;  ///< tasks at once; 0: as many as there is room for
  int cpus = 1;                 ///< of a task
  int task = -1;
};

/// Throws InputError, OutputError, PartialResult.
int run_farm(const FarmOptions& options, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
