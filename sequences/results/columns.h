// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is known of a decision, a frame, a layer, a run: one column per number or word, with its name, its unit,
/// its meaning, and how it is got. The result files (JSONL, CSV), their documentation (docs/outputs.md) and
/// whoever exports them read these tables and nothing else, so a new fiducial or cost is a new column, once.
///
/// The tables themselves are in column_tables.h; their JSON is in column_json.h.

#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "warp/fit.h"

namespace talisman::sequences {

/// Not known, and not even asked for: JSON has no entry (Null: an entry that says null).
struct Absent {
  bool operator==(const Absent&) const = default;
};
struct Null {
  bool operator==(const Null&) const = default;
};
/// What stands in one column. Numbers that are not finite are Null, and those that only say that there is no bound
/// (warp::kHugePx): of fiducials the column `fit` says why.
using Value = std::variant<Absent, Null, bool, std::int64_t, double, std::string>;

inline Value value_of(const Value& value) { return value; }
inline Value value_of(bool value) { return value; }
inline Value value_of(std::integral auto value) { return static_cast<std::int64_t>(value); }
inline Value value_of(double value) {
  return std::fabs(value) < warp::kHugePx ? Value(value) : Value(Null{});  // Null for NaN, too
}
inline Value value_of(std::string_view value) { return std::string(value); }
inline Value value_of(const std::string& value) { return value; }
inline Value value_of(const char* value) { return std::string(value); }
template <typename T>
Value value_of(const std::optional<T>& value) {
  return value ? value_of(*value) : Value(Null{});
}

/// The way back, where a column can be read. Throws std::invalid_argument for a value of another kind.
inline void assign(int& to, const Value& from) {
  if (!std::holds_alternative<std::int64_t>(from)) throw std::invalid_argument("not a whole number");
  to = static_cast<int>(std::get<std::int64_t>(from));
}
inline void assign(std::int64_t& to, const Value& from) {
  if (!std::holds_alternative<std::int64_t>(from)) throw std::invalid_argument("not a whole number");
  to = std::get<std::int64_t>(from);
}
inline void assign(double& to, const Value& from) {
  if (std::holds_alternative<std::int64_t>(from))
    to = static_cast<double>(std::get<std::int64_t>(from));
  else if (std::holds_alternative<double>(from))
    to = std::get<double>(from);
  else
    throw std::invalid_argument("not a number");
}
inline void assign(bool& to, const Value& from) {
  if (!std::holds_alternative<bool>(from)) throw std::invalid_argument("neither true nor false");
  to = std::get<bool>(from);
}
inline void assign(std::string& to, const Value& from) {
  if (!std::holds_alternative<std::string>(from)) throw std::invalid_argument("not a text");
  to = std::get<std::string>(from);
}

/// What a reader sees of a column.
struct ColumnInfo {
  std::string name;  ///< in flat tables; empty: only a place in JSON that other tables fill
  std::string path;  ///< in JSON, members joined by '/': "fiducials/worst_at_px/0"
  std::string unit;  ///< "px", "ms", "bytes", …; empty for words, counts of things that the name says, ratios
  std::string meaning;
};

template <typename Row>
struct Column : ColumnInfo {
  Value (*get)(const Row&) = nullptr;
  void (*set)(Row&, const Value&) = nullptr;  ///< null: computed from others, or not read back
};

/// Columns that are there together or not at all: those whose path begins with `path`/.
template <typename Row>
struct ColumnGroup {
  std::string path;
  std::string meaning;  ///< when it is there
  bool null_if_absent;  ///< JSON says null rather than nothing
  bool (*has)(const Row&);
  void (*make)(Row&) = nullptr;  ///< before its columns are set
};

/// All columns of one kind of row, in the order in which JSON and CSV have them.
template <typename Row>
struct ColumnTable {
  std::string name;    ///< "frames"
  std::string schema;  ///< "talisman.frame/1": the first entry of the JSON; empty: has none
  std::vector<Column<Row>> columns;
  std::vector<ColumnGroup<Row>> groups;
};

/// A column that is computed: `get` takes a row.
template <typename Row, typename Get>
Column<Row> computed(std::string name, std::string path, std::string unit, std::string meaning, Get) {
  return {{std::move(name), std::move(path), std::move(unit), std::move(meaning)},
          [](const Row& row) { return value_of(Get{}(row)); }};
}

/// A column that is a member of the row: `member` takes a row, const or not, and returns a reference.
template <typename Row, typename Member>
Column<Row> stored(std::string name, std::string path, std::string unit, std::string meaning, Member) {
  return {{std::move(name), std::move(path), std::move(unit), std::move(meaning)},
          [](const Row& row) { return value_of(Member{}(row)); },
          [](Row& row, const Value& value) { assign(Member{}(row), value); }};
}

/// The reader's view of a whole table, without the places that other tables fill.
template <typename Row>
std::vector<ColumnInfo> flat_columns(const ColumnTable<Row>& table) {
  std::vector<ColumnInfo> columns;
  for (const Column<Row>& column : table.columns)
    if (!column.name.empty()) columns.push_back(column);
  return columns;
}

}  // namespace talisman::sequences
