// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which order do the jobs of a parallel loop begin: chunks of a sprite, bands of a display, blocks of triangles?
///
/// It must not matter: a job writes what is its own, and sums are made of integers. That claim is tested by other orders than that of
/// the index: for order k > 0, job i of n is number (k + i·s) mod n, s the first number from k·⌊√n⌋ + 1 on that has no divisor in
/// common with n, so that each number comes once.

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace talisman::chunker {

namespace detail {
inline std::atomic<std::uint32_t> job_order{0};
}

/// For all loops that begin from now on; 0: by index, as it is without a call. No result depends on it.
inline void use_job_order(std::uint32_t order) { detail::job_order = order; }

class JobOrder {
 public:
  explicit JobOrder(std::size_t jobs) : JobOrder(jobs, detail::job_order) {}
  JobOrder(std::size_t jobs, std::uint32_t order) : jobs_(jobs == 0 ? 1 : jobs) {
    if (order == 0) return;
    first_ = order % jobs_;
    stride_ = (order * static_cast<std::size_t>(std::sqrt(static_cast<double>(jobs_))) + 1) % jobs_;
    while (std::gcd(stride_, jobs_) != 1) ++stride_;
  }
  /// Number of the job that begins as the i-th; i < jobs < 2³².
  std::size_t operator[](std::size_t i) const { return (first_ + i * stride_) % jobs_; }

 private:
  std::size_t jobs_, first_ = 0, stride_ = 1;
};

}  // namespace talisman::chunker
