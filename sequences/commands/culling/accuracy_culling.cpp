// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/culling/accuracy_culling.h"

#include <algorithm>

#include "sequences/experiments/culling/measured.h"
#include "sequences/experiments/culling/visibility.h"
#include "sequences/experiments/memory/measured.h"

namespace talisman::sequences {

int run_culling_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  run_policy_experiment("direct", measure_culling, options, dir, out);
  return kSuccess;
}

int run_visibility_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  const VisibilityExperiment experiment =
      run_policy_experiment("direct", measure_visibility, options, dir, out);
  const bool differs = std::any_of(experiment.results.begin(), experiment.results.end(),
                                   [](const VisibilityResult& r) { return r.differing > 0; });
  return differs ? kFailed : kSuccess;
}

int run_memory_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  ExperimentOptions asked = options;
  if (asked.size.empty()) asked.size = kDisplayOfFu93;
  const regulator::MemoryLimits limits{options.memory_mb.value_or(kMemory_mb),
                                       options.io_mb_per_s.value_or(kIo_mb_per_s)};
  if (const std::string defect = first_defect(limits); !defect.empty()) throw InputError(defect);
  run_policy_experiment(
      "direct",
      [&limits](const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames,
                ProgressKind progress) {
        return measure_memory(sequence, settings, frames, limits, progress);
      },
      asked, dir, out);
  return kSuccess;
}

}  // namespace talisman::sequences
