// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/motion/accuracy_lod.h"

#include "sequences/experiments/lod/measured.h"

namespace talisman::sequences {

int run_lod_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out) {
  run_policy_experiment("", measure_lod, options, dir, out);
  return kSuccess;
}

}  // namespace talisman::sequences
