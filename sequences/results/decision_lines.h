// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which decisions get a line in decisions.jsonl (DecisionLines in run_options.h). `Changed` is for long runs: of a layer
/// that goes on being reused nothing is said until it is drawn or dropped. Memory: one word per layer.

#include <map>
#include <string>

#include "sequences/results/column_tables.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

class DecisionFilter {
 public:
  explicit DecisionFilter(DecisionLines lines) : lines_(lines) {}

  /// Before the rows of each frame.
  void begin_frame() {
    before_ = std::move(now_);
    now_.clear();
  }
  bool has_line(const DecisionRow& row) {
    if (lines_ != DecisionLines::Changed) return lines_ == DecisionLines::All;
    now_[row.name] = row.decision.action;
    const auto before = before_.find(row.name);
    return row.decision.action == regulator::Action::Rerender ||
           row.decision.action == regulator::Action::Refresh || before == before_.end() ||
           before->second != row.decision.action;
  }

 private:
  DecisionLines lines_;
  std::map<std::string, regulator::Action> before_, now_;
};

/// As on the command line and in run.json.
inline const char* word_of(DecisionLines lines) {
  switch (lines) {
    case DecisionLines::Changed:
      return "changed";
    case DecisionLines::None:
      return "none";
    case DecisionLines::All:
      break;
  }
  return "all";
}

}  // namespace talisman::sequences
