// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/goal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

double worst_of(std::span<const double> badness) {
  return badness.empty() ? 0 : *std::max_element(badness.begin(), badness.end());
}

double mean_of(std::span<const double> badness) {
  if (badness.empty()) return 0;
  return std::accumulate(badness.begin(), badness.end(), 0.0) / static_cast<double>(badness.size());
}

std::string TuneGoal::quantity() const {
  if (kind == GoalKind::Flip) return "FLIP";
  return kind == GoalKind::Psnr ? "PSNR" : "modelled ms";
}

std::string TuneGoal::in_words() const {
  const char* which = of_mean ? "mean" : "worst";
  if (kind == GoalKind::Flip) return formatted("%s FLIP at most %g", which, limit);
  if (kind == GoalKind::Psnr) return formatted("%s PSNR at least %g dB", which, limit);
  return formatted("%s modelled drawing time of a frame at most %g ms", which, limit);
}

double TuneGoal::badness_of(const Quality& quality) const {
  return kind == GoalKind::Flip ? quality.flip : std::pow(10, -quality.psnr_db / 10);
}

double TuneGoal::largest_badness() const {
  return kind == GoalKind::Psnr ? std::pow(10, -limit / 10) : limit;
}

double TuneGoal::shown(double badness) const {
  return kind == GoalKind::Psnr ? -10 * std::log10(badness) : badness;
}

std::string TuneGoal::text_of(double badness) const {
  if (!std::isfinite(shown(badness))) return "identical";
  return fixed(shown(badness), kind == GoalKind::Flip ? 5 : 2) + (kind == GoalKind::Psnr ? " dB" : "");
}

bool TuneGoal::holds(std::span<const double> badness) const {
  return (of_mean ? mean_of(badness) : worst_of(badness)) <= largest_badness();
}

}  // namespace talisman::sequences
