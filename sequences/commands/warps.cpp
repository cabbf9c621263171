// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/warps.h"

#include <ostream>
#include <utility>

#include "sequences/commands/experiment_options.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/warps/experiment.h"
#include "sequences/experiments/warps/report.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

int run_warps(const WarpsOptions& options, std::ostream& out) {
  const layers::BoundKind bound = choice("--bound", options.bound, kBoundWords);
  const ProgressKind progress = choice("--progress", options.progress, kProgressWords);
  require_plotter();
  std::vector<WarpObject> objects;
  std::vector<MissingObject> missing;
  if (options.object.empty())
    objects = load_warp_objects(missing);
  else
    objects.push_back(load_warp_object(options.object));
  prepare_folder(options.out);
  WarpReport report = measure_warps(std::move(objects), std::move(missing), bound, progress);
  report.bound = options.bound;
  write_report(report, options.out);
  print_report(report, out);
  out << "\nresults in " << options.out << "\n";
  return report.missing.empty() ? kSuccess : kPartialResult;
}

}  // namespace talisman::sequences
