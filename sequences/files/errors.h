// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What goes wrong outside the program. Only readers and writers in this folder throw; `main` catches, prints
/// one line `error: FILE:LINE: what, the value, the rule` on stderr and returns the exit code.

#include <stdexcept>
#include <string>

namespace talisman::sequences {

enum ExitCode { kSuccess = 0, kFailed = 1, kBadInput = 2, kPartialResult = 3 };

/// Bad arguments or a bad input file: exit code 2. `file` and `line` may be empty and 0.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& what_value_rule, const std::string& file = {}, int line = 0)
      : std::runtime_error(place(file, line) + what_value_rule) {}

 private:
  static std::string place(const std::string& file, int line) {
    if (file.empty()) return {};
    return line > 0 ? file + ":" + std::to_string(line) + ": " : file + ": ";
  }
};

/// An output could not be written (disk full, folder not writable), a child failed: exit code 1.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An output could not be written after some frames were: they are complete and stay. Exit code 3.
class PartialResult : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace talisman::sequences
