// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Other programs (ffmpeg, gnuplot), run without a shell: no argument is ever interpreted by anything but its
/// receiver.

#include <cstdint>
#include <string>
#include <vector>

namespace talisman::sequences {

/// What a child that reads strangers' files may use. 0: not limited.
struct ChildLimits {
  int seconds = 0;                ///< of processor time; it is waited for ten times as long
  std::int64_t memory_bytes = 0;  ///< address space
  std::int64_t file_bytes = 0;    ///< of the largest file that it writes
};

struct ChildOptions {
  std::string directory;    ///< working directory of the child; empty: ours
  std::string stdin_file;   ///< read by the child; empty: nothing to read
  std::string stdout_file;  ///< created or emptied; empty: kept with stderr
  ChildLimits limits{};
};

struct ChildResult {
  bool timed_out = false;  ///< it was ended because it took longer than its limits allow
  bool started = false;    ///< false: not found or not executable; `output` says why
  int exit_code = -1;      ///< 128 + signal number when it was killed by one
  std::string output;      ///< the last 64 KiB of stderr (and stdout, unless it went to a file)
  bool succeeded() const { return started && exit_code == 0; }
  /// The last `lines` lines of output that are not blank, joined by " | "; the exit code when there are none.
  std::string reason(int lines = 3) const;
};

/// Runs `arguments[0]`, found by PATH, and waits for its end.
ChildResult run_child(const std::vector<std::string>& arguments, const ChildOptions& options = {});

}  // namespace talisman::sequences
