// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Choices of a multiple-choice knapsack that are changed one layer at a time: the fill pass and the exchanges of
/// regulator/lod/solver.h.

#include <cstdint>
#include <vector>

namespace talisman::regulator {

/// What there is to choose from, in whole units of time.
struct WholeProblem {
  std::vector<std::int64_t> costs;  ///< by choice; kNeverTaken: cannot be taken
  std::vector<double> benefits;
  std::vector<int> first{0};  ///< as LodProblem::first
  std::int64_t budget = 0;
  int layers() const { return static_cast<int>(first.size()) - 1; }
};
inline constexpr std::int64_t kNeverTaken = std::int64_t{1} << 48;  // 32,000 layers of it still add up

struct Picked {
  std::vector<int> at;  ///< by layer, an index into WholeProblem::costs
  std::int64_t cost = 0;
  double benefit = 0;
};

/// Sets what it costs and gives, summed in the order of the layers.
Picked priced(const WholeProblem& problem, std::vector<int> at);

/// What still fits, the best Δ benefit / Δ cost first; ties by layer. `held` keeps its choice; -1: none does.
/// Cost: O(n + changes · log n).
Picked filled(const WholeProblem& problem, Picked picked, int held = -1);

/// One layer after the other is put to each of its choices, others are lowered until that fits, those that lose least per
/// time saved first, and it is filled; the best of all is kept, as long as that gains. Cost: O(n²) as a rule, per gain.
Picked exchanged(const WholeProblem& problem, Picked picked, double upper_bound);

}  // namespace talisman::regulator
