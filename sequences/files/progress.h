// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Progress of long work on stderr: a bar on a terminal, otherwise one flushed "NN%" line per ten per cent, both
/// with frames per second and the time left.

#include <chrono>
#include <string>

namespace talisman::sequences {

enum class ProgressKind { Auto, Bar, Plain, None };

class Progress {
 public:
  /// `total` steps, of which `done` are there already (they do not count for the speed).
  Progress(ProgressKind kind, std::string what, int total, int done = 0);
  ~Progress();
  void advance();

 private:
  void print();

  ProgressKind kind_;
  std::string what_;
  int total_, done_, done_at_start_;
  int last_percent_ = -1;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace talisman::sequences
