// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sum of doubles that does not depend on the order, nor on how its terms were parted: what runs on several machines
/// add up is, added up, what one machine would have.
///
/// The sum is kept as an expansion: numbers p₁ … pₙ that do not overlap, smallest first, whose sum is exactly that of all
/// terms [Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997, grow-expansion]. `value` rounds it once, to the
/// nearest double, ties to even. Finite terms below 1e300; some ns each, n is rarely above 3.

#include <cmath>
#include <utility>
#include <vector>

namespace talisman::sequences {

class ExactSum {
 public:
  ExactSum() = default;
  /// Of parts that were kept (`parts`).
  explicit ExactSum(const std::vector<double>& parts) {
    for (const double part : parts) add(part);
  }

  ExactSum& operator+=(double term) { return add(term), *this; }
  ExactSum& operator+=(const ExactSum& other) {
    const std::vector<double> terms = other.parts_;
    for (const double term : terms) add(term);
    return *this;
  }
  operator double() const { return value(); }  // NOLINT: it is a number

  double value() const {
    std::size_t n = parts_.size();
    if (n == 0) return 0;
    double high = parts_[--n], low = 0;
    while (n > 0 && low == 0) {
      const double x = high, y = parts_[--n];
      high = x + y;
      low = y - (high - x);
    }
    // Half way between two doubles: what is left below decides, not the even one.
    if (n > 0 && ((low < 0 && parts_[n - 1] < 0) || (low > 0 && parts_[n - 1] > 0))) {
      const double twice = 2 * low, next = high + twice;
      if (twice == next - high) high = next;
    }
    return high;
  }
  const std::vector<double>& parts() const { return parts_; }
  bool operator==(const ExactSum&) const = default;

 private:
  void add(double x) {
    std::size_t kept = 0;
    for (double y : parts_) {
      if (std::fabs(x) < std::fabs(y)) std::swap(x, y);
      const double high = x + y, low = y - (high - x);
      if (low != 0) parts_[kept++] = low;
      x = high;
    }
    parts_.resize(kept);
    if (x != 0) parts_.push_back(x);
  }

  std::vector<double> parts_;
};

}  // namespace talisman::sequences
