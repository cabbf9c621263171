// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is to hold, in the worst frame or in the mean of all?
///
///   Flip        FLIP against `reference` ≤ limit, 0 … 1
///   Psnr        PSNR against `reference` ≥ limit, dB; in the mean that of the mean squared error
///   BudgetMs    modelled drawing time of a frame (frames.jsonl, modelled_drawing_ms) ≤ limit, ms
///
/// All three are compared as a *badness* that grows with the fault: FLIP; the squared error relative to 255²,
/// 10^(-PSNR / 10); ms.

#include <span>
#include <string>

#include "sequences/pictures/quality.h"

namespace talisman::sequences {

enum class GoalKind { Flip, Psnr, BudgetMs };

struct TuneGoal {
  GoalKind kind = GoalKind::Flip;
  double limit = 0;
  bool of_mean = false;

  bool is_of_pictures() const { return kind != GoalKind::BudgetMs; }
  /// "FLIP", "PSNR", "modelled ms".
  std::string quantity() const;
  /// "worst FLIP at most 0.01".
  std::string in_words() const;
  /// Of a picture; goals of pictures alone.
  double badness_of(const Quality& quality) const;
  double largest_badness() const;
  /// The quantity as it is printed, from a badness.
  double shown(double badness) const;
  /// "0.0123", "41.52 dB", "7.31", "identical".
  std::string text_of(double badness) const;
  /// Of all frames.
  bool holds(std::span<const double> badness) const;
};

double worst_of(std::span<const double> badness);  ///< 0 of none
double mean_of(std::span<const double> badness);

}  // namespace talisman::sequences
