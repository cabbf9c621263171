// SPDX-License-Identifier: Apache-2.0
#include "regulator/amortise.h"

#include <cmath>

namespace talisman::regulator {

Amortisation durbin_1995(std::int64_t polygons) {
  constexpr double kUnoptimised_ms = 12.7e-3, kOptimised_ms = 3.8e-3, kOnce_ms = 87.9e-3;  // a polygon
  const auto n = static_cast<double>(polygons);
  return {kUnoptimised_ms * n, kOptimised_ms * n, kOnce_ms * n};
}

double break_even_frames(const Amortisation& terms) {
  const double saved_ms = terms.unoptimised_ms - terms.optimised_ms;
  return saved_ms > 0 ? terms.once_ms / saved_ms : HUGE_VAL;
}

bool pays(const Amortisation& terms, double frames) {
  return std::isfinite(frames) && std::isfinite(terms.once_ms) && frames > break_even_frames(terms);
}

void RunLength::ended(double recency) {
  mean_ = runs_ == 0 ? current_ : mean_ + recency * (current_ - mean_);
  ++runs_;
  current_ = 0;
}

}  // namespace talisman::regulator
