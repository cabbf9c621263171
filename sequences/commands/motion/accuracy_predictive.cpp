// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_predictive.h"

#include "sequences/experiments/predictive/measured.h"

namespace talisman::sequences {

int run_predictive_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  run_policy_experiment("predictive", measure_predictive, options, dir, out);
  return kSuccess;
}

}  // namespace talisman::sequences
