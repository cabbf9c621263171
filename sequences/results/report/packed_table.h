// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A table of results as packed columns (packed_column.h): what the page holds of decisions.jsonl, frames.jsonl and
/// timing.jsonl. Its columns are those of column_tables.h, read back from the files; nothing is rounded.
///
/// A reason is text with numbers of the same row, "geometric 0.9929 <= 1 px": where one of the row's columns, printed with
/// four digits, stands in it, the word of the list has a mark in its place (U+0001 and a letter, 'a' the first of
/// `reason_numbers`), so that 400,000 reasons become a few dozen words. The page prints the number back.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sequences/results/report/flat_line.h"
#include "sequences/results/report/packed_column.h"

namespace talisman::sequences {

/// One column; of words, of numbers, or (nothing but null) of neither.
struct PackedField {
  ColumnInfo info;
  std::optional<PackedColumn> packed{};
  bool is_words = false;
  std::vector<std::string> words{};  ///< index 0: null
  std::map<std::string, std::uint32_t> index_of{};
};

class PackedTable {
 public:
  /// `series`: the name of a column of words whose rows follow each other in time; empty: all rows do.
  explicit PackedTable(std::vector<ColumnInfo> columns, const std::string& series = {});

  /// Throws std::invalid_argument where a column has words and numbers.
  void add(const std::vector<Cell>& row);

  std::size_t rows() const { return series_of_row_.size(); }
  std::vector<PackedField>& fields() { return fields_; }
  const std::vector<std::string>& reason_numbers() const { return reason_numbers_; }
  /// The row's column of that name; null where there is none.
  const Cell* cell(const std::vector<Cell>& row, const std::string& name) const;

 private:
  void start(PackedField& field, bool is_words);
  std::string with_marks(const std::string& reason, const std::vector<Cell>& row) const;
  static std::uint32_t index(PackedField& field, const std::string& word);

  std::vector<PackedField> fields_;
  std::map<std::string, std::size_t> by_name_;
  std::vector<std::string> reason_numbers_;
  std::optional<std::size_t> series_, reason_;
  std::vector<std::uint32_t> series_of_row_;
};

/// `value` as "%.4g" has it, if the page's way to print it (four significant digits, no zeros behind) gives the same.
std::optional<std::string> four_digits(double value);

}  // namespace talisman::sequences
