// SPDX-License-Identifier: Apache-2.0
#pragma once

/// changes.jsonl beside decisions.jsonl: both go from frame to frame, so no more than one frame of it is held.

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "sequences/results/report/changes.h"
#include "sequences/results/report/flat_line.h"

namespace talisman::sequences {

class ChangesBeside {
 public:
  /// The columns that stand beside those of a decision.
  static std::vector<ColumnInfo> columns_beside();

  /// Empty: there is no such file. Throws InputError where a line is none of ours; a last one that is cut off does not count.
  explicit ChangesBeside(std::string file);

  bool is_there() const { return !file_.empty(); }
  /// Appends what is known of the layer in the frame, or as many cells of nothing. Frames do not fall.
  void append_to(std::vector<Cell>& row, int frame, const std::string& layer);

 private:
  void read_on();

  std::vector<ColumnInfo> columns_ = flat_columns(change_table());
  std::string file_;
  std::ifstream in_;
  FlatLine line_;
  int number_ = 0, frame_ = -1, next_frame_ = -1;  ///< of the line read last; that is held; that comes
  std::string next_layer_;
  std::vector<Cell> next_;
  std::map<std::string, std::vector<Cell>> rows_;  ///< of `frame_`, by layer
};

}  // namespace talisman::sequences
