// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sequence files of which one line is wrong.

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::tests {

struct Fault {
  int line;                ///< 1 …
  std::string text;        ///< instead of that line
  std::string message;     ///< part of the error
  bool elsewhere = false;  ///< noticed at another line: where something is missing, or at the file's end
};

inline std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// `load(lines)` must refuse `right` with each of the faults, and name file and line.
inline void expect_refused(const std::vector<std::string>& right, const std::vector<Fault>& faults,
                           const std::function<void(const std::vector<std::string>&)>& load) {
  for (const Fault& fault : faults) {
    std::vector<std::string> lines = right;
    lines[fault.line - 1] = fault.text;
    const std::string message = message_of([&] { load(lines); });
    EXPECT_THAT(message, testing::HasSubstr(fault.message)) << fault.text;
    const std::string place =
        fault.elsewhere ? "test.yaml:" : "test.yaml:" + std::to_string(fault.line) + ":";
    EXPECT_THAT(message, testing::HasSubstr(place)) << fault.text;
  }
}

}  // namespace talisman::tests
