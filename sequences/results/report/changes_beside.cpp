// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/report/changes_beside.h"

#include <utility>

#include "sequences/files/errors.h"

namespace talisman::sequences {

std::vector<ColumnInfo> ChangesBeside::columns_beside() {
  std::vector<ColumnInfo> columns = flat_columns(change_table());
  columns.erase(columns.begin(), columns.begin() + kChangeKeys);
  return columns;
}

ChangesBeside::ChangesBeside(std::string file)
    : file_(std::move(file)), in_(file_, std::ios::binary), line_(columns_) {
  read_on();
}

void ChangesBeside::append_to(std::vector<Cell>& row, int frame, const std::string& layer) {
  while (next_frame_ >= 0 && next_frame_ <= frame) {
    if (next_frame_ != frame_) rows_.clear();
    frame_ = next_frame_;
    rows_[next_layer_] = std::move(next_);
    read_on();
  }
  const auto found = frame_ == frame ? rows_.find(layer) : rows_.end();
  if (found == rows_.end())
    row.resize(row.size() + columns_.size() - kChangeKeys);
  else
    row.insert(row.end(), found->second.begin(), found->second.end());
}

void ChangesBeside::read_on() {
  std::string text;
  next_frame_ = -1;
  if (!std::getline(in_, text) || in_.eof()) return;  // no end of line: is being written
  ++number_;
  if (!line_.read(text) || line_.schema() != change_table().schema)
    throw InputError("is no line of ours, must be of schema " + change_table().schema, file_, number_);
  const std::vector<Cell>& cells = line_.cells();
  next_frame_ = static_cast<int>(cell_or_0(cells.data()));
  next_layer_ = cell_word(&cells[1]);
  next_.assign(cells.begin() + kChangeKeys, cells.end());
}

}  // namespace talisman::sequences
