// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/accuracy_factoring.h"

#include <cstdio>
#include <ostream>

#include "sequences/commands/experiment_options.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {

FactoringReport measure_factoring_report(const Sequence& sequence, const RegulatorCommandOptions& options) {
  if (!is_factored(sequence))
    throw InputError(
        sequence.name +
        ": no layer factors a shade term, rule: some layer has `shading` that the scene calls for");
  CommandLine line;
  line.frames = options.frames;
  line.size = options.size.empty() ? default_experiment_size(sequence.display_px) : options.size;
  line.progress = options.progress;
  const ResolvedRun run = resolve(line, sequence, true);
  FactoringReport report;
  report.sequence = sequence.name;
  report.policy = regulator::name(run.settings.regulator.policy);
  report.warp = warp::name(run.settings.curve);
  report.display_px = run.settings.view.display_px;
  report.frames = experiment_frames(run, options.quality_every);
  report.result = measure_factoring({sequence, run.settings}, report.frames, run.options.progress);
  return report;
}

int run_factoring_accuracy(const RegulatorCommandOptions& options, const std::string& dir,
                           std::ostream& out) {
  progress_kind_from(options.progress);
  const Sequence sequence = load_sequence(options.sequence);
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  const FactoringReport report = measure_factoring_report(sequence, options);
  create_folder(dir);
  write_report(report, dir);
  print_report(report, out);
  out << "\nresults in " << dir << "\n";
  return kSuccess;
}

}  // namespace talisman::sequences
