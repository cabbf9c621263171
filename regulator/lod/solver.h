// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is each layer shown, so that a frame gives most within its time? A multiple-choice knapsack.
///
///   maximise Σ b(i, c_i)   with   Σ t(i, c_i) ≤ T        c_i: one choice of layer i: warp or draw, level, resolution
///                                                        b benefit, t modelled ms
///
/// [Fu93 4.4] takes choices by b / t of the whole item. That is not half of the best, as the paper says: an item of
/// benefit 2 at cost 1 shuts out one of 100 at 100 where T = 100. Here:
///
///   1  of each layer the upper hull of its choices over cost: steps of falling slope Δb / Δt (marginal, not total)
///   2  all steps by slope, steepest first, until one does not fit: with the part of it that fits, the best that divisible
///      choices could give, an upper bound of b (Zemel 1980, Dyer 1984)
///   3  what fits of the steps of that slope, and then a fill pass: the best Δb / Δt of anything that still fits
///   4  where that is not near the bound: from the cheapest, the step that did not fit alone, and filled; the better of both
///      is at least half of the best, since the two together are more than the bound. In small frames, also each choice
///      given up or forced in turn, filled again, as long as that gains (kSmallProblem).
///
/// The slope at which it ends is found by halving what is left, not by sorting (Balas & Zemel 1980): O(n). It changes little
/// from frame to frame, so that of the last one is tried first: where nothing has changed, one iteration. What was solved
/// before makes it faster and never changes the answer: time is counted in whole picoseconds, so sums are exact in any order.

#include <cstdint>
#include <span>
#include <vector>

#include "regulator/lod/picked.h"

namespace talisman::regulator {

/// One way to show a layer.
struct LodChoice {
  double cost_ms = 0;  ///< ≥ 0; infinite or no number: cannot be taken
  double benefit = 0;  ///< ≥ 0; no number counts as 0
  bool operator==(const LodChoice&) const = default;
};

/// The choices of all layers: those of layer i are choices[first[i]] … choices[first[i + 1] - 1], at least one.
struct LodProblem {
  std::vector<LodChoice> choices;
  std::vector<int> first{0};
  double budget_ms = 0;  ///< ≥ 0; infinite: no limit
  int layers() const { return static_cast<int>(first.size()) - 1; }
  /// Appends a layer.
  void add(std::span<const LodChoice> of_layer);
};

struct LodSolution {
  bool fits = true;  ///< false: the cheapest choices alone exceed the budget; they are what is chosen
  std::vector<int>
      chosen;  ///< by layer, counted from its first choice; of equals the cheapest, of these the first
  double cost_ms = 0, benefit = 0;
  double upper_bound = 0;  ///< no choice within the budget has more benefit
  int iterations = 0;      ///< of step 2
};

/// Problems of at most so many choices are improved by trying each.
inline constexpr int kSmallProblem = 192;
/// … and where the bound says that less than this share could be gained, nothing is tried.
inline constexpr double kNearEnough = 0.995;

/// One after the other, each from where the last one ended.
class LodSolver {
 public:
  /// Cost: O(n), n choices, as a rule; O(n² log n) in small frames.
  LodSolution solve(const LodProblem& problem);

 private:
  /// From one choice on the hull to the next.
  struct Step {
    double slope = 0;  ///< benefit per picosecond
    std::int64_t cost = 0;
    int to = -1;  ///< index into the choices
  };
  /// Where divisible choices would end.
  struct Break {
    double slope = -1;              ///< of the step that is not taken whole; -1: all are
    std::int64_t steeper_cost = 0;  ///< of all steeper ones
    int iterations = 0;
  };
  void rebuild(const LodProblem& problem);
  void add_hull(int layer, std::int64_t slack);
  Break find_break(std::int64_t slack) const;
  Picked greedy(const Break& where, int& first_left_out) const;
  Picked improved(Picked picked, int left_out, double upper_bound) const;

  LodProblem last_;
  bool has_last_ = false;
  WholeProblem whole_;
  Picked cheapest_;
  std::vector<Step> steps_;  ///< by layer, along its hull
  std::vector<int> first_step_;
  std::vector<int> order_;  ///< of one layer, while it is looked at
  double last_slope_ = -1;
};

/// As of a solver that has solved nothing.
LodSolution solve(const LodProblem& problem);

}  // namespace talisman::regulator
