// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What long work is at, where nobody knows how many steps there will be: one line on a terminal, which each stage writes
/// over and the end clears. Nothing anywhere else.

#include <memory>
#include <string>

namespace talisman::sequences {

class StageLine {
 public:
  explicit StageLine(std::string what);
  /// The next stage begins. The line goes when the last copy does.
  void operator()(const std::string& stage) const;

 private:
  struct Line;
  std::shared_ptr<Line> line_;
};

}  // namespace talisman::sequences
