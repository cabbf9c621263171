// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_amortised.h"

#include "sequences/experiments/amortised/measured.h"

namespace talisman::sequences {

int run_amortised_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  run_policy_experiment("threshold", measure_amortised, options, dir, out);
  return kSuccess;
}

}  // namespace talisman::sequences
