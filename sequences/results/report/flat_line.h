// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A line of JSON as a row of numbers and words: what stands at the places of a table of columns (results/columns.h).
///
/// The line is read once, from left to right, without a tree: a run of 10,000 frames and 40 layers has 400,000 of them.

#include <string>
#include <variant>
#include <vector>

#include "sequences/results/columns.h"

namespace talisman::sequences {

/// std::monostate: null, or not there.
using Cell = std::variant<std::monostate, double, std::string>;

/// Of a cell that may not be there: its number, else not-a-number, or 0; its word, else none.
double cell_number(const Cell* cell);
double cell_or_0(const Cell* cell);
std::string cell_word(const Cell* cell);

class FlatLine {
 public:
  explicit FlatLine(const std::vector<ColumnInfo>& columns);

  /// False where the text is no JSON object, as the last line of a killed run is not.
  bool read(const std::string& text);
  const std::vector<Cell>& cells() const { return cells_; }  ///< of the line read last, by column
  const std::string& schema() const { return schema_; }      ///< its `schema`

 private:
  struct Node {
    std::vector<std::pair<std::string, int>> children;  ///< name or index, node
    int column = -1;
  };
  struct Handler;

  int child(int node, const std::string& name) const;

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
  std::string schema_;
};

}  // namespace talisman::sequences
