// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/traces/trace_findings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace talisman::sequences {

namespace {

constexpr double kLeastValue = 1e-9, kMostValue = 1e15;
constexpr std::size_t kFew = 4096;
const double kLogOfBin = std::log(1.01);

int bin_of(double value) { return static_cast<int>(std::log(value / kLeastValue) / kLogOfBin); }

}  // namespace

void LogHistogram::add(double value) {
  ++count_;
  max_ = std::max(max_, value);
  if (static_cast<std::size_t>(count_) <= kFew) {
    first_.push_back(value);
    return;
  }
  for (const double before : std::exchange(first_, {})) add_to_bin(before);
  add_to_bin(value);
}

void LogHistogram::add_to_bin(double value) {
  if (!(value >= kLeastValue)) {
    ++zeros_;
    return;
  }
  if (bins_.empty()) bins_.resize(static_cast<std::size_t>(bin_of(kMostValue)) + 1);
  ++bins_[static_cast<std::size_t>(bin_of(std::min(value, kMostValue)))];
}

double LogHistogram::quantile(double q) const {
  if (count_ == 0) return 0;
  const auto rank = std::min(static_cast<std::int64_t>(q * static_cast<double>(count_)), count_ - 1);
  if (!first_.empty()) {
    std::vector<double> sorted = first_;
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    return sorted[static_cast<std::size_t>(rank)];
  }
  std::int64_t below = zeros_;
  if (rank < below) return 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin)
    if ((below += bins_[bin]) > rank)
      return std::min(max_, kLeastValue * std::exp((static_cast<double>(bin) + 0.5) * kLogOfBin));
  return max_;
}

std::vector<TraceGap> TraceFindings::gaps() const {
  std::vector<TraceGap> gaps = longest_steps;
  const double longest_s = 3 * period_s();
  // Half a bin more, so that a step of just three periods is none.
  std::erase_if(gaps, [&](const TraceGap& gap) { return !(gap.length_s > 1.005 * longest_s); });
  return gaps;
}

}  // namespace talisman::sequences
