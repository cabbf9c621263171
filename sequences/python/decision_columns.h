// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The table of decisions (results/column_tables.h) by columns, as NumPy and data frames have it.

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// All values of one column are of one kind: whole numbers, truths, fractions (what does not exist is NaN) or
/// words (what does not exist is empty).
struct DecisionColumn {
  std::string name;
  std::variant<std::vector<std::int64_t>, std::vector<bool>, std::vector<double>, std::vector<std::string>>
      values;
};

class DecisionColumns {
 public:
  DecisionColumns();
  ~DecisionColumns();
  /// A row per layer that has a line in decisions.jsonl.
  void add(const PipelineState& state, const FrameReport& report);
  /// Whole numbers some of which do not exist become fractions.
  std::vector<DecisionColumn> columns() const;

 private:
  struct Rows;
  std::unique_ptr<Rows> rows_;
};

}  // namespace talisman::sequences
