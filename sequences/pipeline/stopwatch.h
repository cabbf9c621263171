// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Wall time, for reports alone: no decision reads it.

#include <chrono>

namespace talisman::sequences {

class Stopwatch {
 public:
  /// Since it was made.
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace talisman::sequences
