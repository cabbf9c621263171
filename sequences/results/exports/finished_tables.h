// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The tables of a complete run, as they lie in its folder: what every export reads.
///
///   decisions   one row per frame and layer       from decisions.jsonl
///   frames      one per frame                     from frames.jsonl
///   timing      one per frame, wall times         from timing.jsonl
///   layers      one per layer                     from summary.json
///   effects     one per effect                    from summary.json
///   run         one                               from summary.json
///
/// The columns are those of column_tables.h; docs/outputs.md lists them.

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/results/columns.h"

namespace talisman::sequences {

using ExportedRow = nlohmann::ordered_json;

struct FinishedTable {
  std::string name;  ///< "decisions"
  std::vector<ColumnInfo> columns;
  /// Hands over row after row: memory does not grow with the run. Throws InputError where a file is not of the run.
  std::function<void(const std::function<void(const ExportedRow&)>&)> read;
};

/// All of them in the order above, `timing` only where it is asked for. Throws InputError where `folder` holds no
/// complete run.
std::vector<FinishedTable> finished_tables(const std::string& folder, bool with_timing);

/// Where the values of a table's columns are in its rows.
class RowPlaces {
 public:
  explicit RowPlaces(const std::vector<ColumnInfo>& columns);
  std::size_t size() const { return places_.size(); }
  /// The value of the k-th column; null: there is none.
  const ExportedRow* at(const ExportedRow& row, std::size_t k) const;

 private:
  std::vector<ExportedRow::json_pointer> places_;
};

}  // namespace talisman::sequences
