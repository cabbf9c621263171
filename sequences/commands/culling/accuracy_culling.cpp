// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/culling/accuracy_culling.h"

#include <algorithm>

#include "sequences/experiments/culling/measured.h"
#include "sequences/experiments/culling/visibility.h"

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

}  // namespace talisman::sequences
