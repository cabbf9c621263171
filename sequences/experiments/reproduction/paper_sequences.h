// SPDX-License-Identifier: Apache-2.0
#pragma once

/// On which of our sequences are the paper's claims tried? [LS97 7, Fig. 21 to 26]
///
/// On the one that is made after the paper's where it is at hand, else on another: the words of the rows name it, and
/// what it says binds nobody.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper_bench.h"

namespace talisman::sequences {

struct PaperSequence {
  std::string name;
  bool is_papers_own = false;  ///< made after the paper's, not one that stands in for it
};
PaperSequence barnyard_sequence();
PaperSequence canyon_sequence();
/// Empty name: there is none, and nothing can stand in.
PaperSequence chicken_sequence();

/// A camera that moves through a static scene, as the figures 22 and 23 compare it. They live as long as the workbench.
struct BarnyardPlans {
  const PlannedRun *held = nullptr, *interpolated = nullptr;
  std::vector<const PlannedRun*> thresholds;  ///< barnyard_thresholds()
};
/// The thresholds of the paper's figures, px.
std::vector<double> barnyard_thresholds();
/// `speed` of all motion; 1 is that of the sequence.
BarnyardPlans barnyard_plans(PaperBench& bench, double speed);

}  // namespace talisman::sequences
