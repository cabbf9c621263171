// SPDX-License-Identifier: Apache-2.0
#include "sequences/python/decision_columns.h"

#include <algorithm>
#include <cmath>

#include "sequences/pipeline/aggregates.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

/// Of one column, one entry per row.
using Values = std::vector<Value>;

template <typename T>
bool has(const Values& values) {
  return std::any_of(values.begin(), values.end(),
                     [](const Value& v) { return std::holds_alternative<T>(v); });
}

double number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* truth = std::get_if<bool>(&value)) return *truth;
  if (const auto* fraction = std::get_if<double>(&value)) return *fraction;
  return NAN;
}

template <typename T>
std::vector<T> all_of(const Values& values) {
  std::vector<T> result;
  result.reserve(values.size());
  for (const Value& value : values) {
    const T* found = std::get_if<T>(&value);
    result.push_back(found ? *found : T{});
  }
  return result;
}

std::vector<double> numbers(const Values& values) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const Value& value : values) result.push_back(number(value));
  return result;
}

DecisionColumn column(const std::string& name, const Values& values) {
  if (has<std::string>(values)) return {name, all_of<std::string>(values)};
  const bool whole = !has<Null>(values) && !has<Absent>(values) && !has<double>(values);
  if (whole && has<std::int64_t>(values)) return {name, all_of<std::int64_t>(values)};
  if (whole && has<bool>(values)) return {name, all_of<bool>(values)};
  return {name, numbers(values)};
}

}  // namespace

struct DecisionColumns::Rows {
  std::vector<Values> by_column = std::vector<Values>(decision_table().columns.size());
  std::vector<int> groups;  ///< by column; -1: always there
};

DecisionColumns::DecisionColumns() : rows_(std::make_unique<Rows>()) {
  const auto& table = decision_table();
  for (const auto& column : table.columns) {
    int group = -1;
    for (std::size_t g = 0; g < table.groups.size(); ++g)
      if (column.path.rfind(table.groups[g].path + "/", 0) == 0) group = static_cast<int>(g);
    rows_->groups.push_back(group);
  }
}
DecisionColumns::~DecisionColumns() = default;

void DecisionColumns::add(const PipelineState& state, const FrameReport& report) {
  const auto& table = decision_table();
  for (const DecisionRow& row : decision_rows(state, report)) {
    std::vector<bool> has_group;
    for (const auto& group : table.groups) has_group.push_back(group.has(row));
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const int group = rows_->groups[k];
      rows_->by_column[k].push_back(group < 0 || has_group[group] ? table.columns[k].get(row)
                                                                  : Value(Null{}));
    }
  }
}

std::vector<DecisionColumn> DecisionColumns::columns() const {
  const auto& table = decision_table().columns;
  std::vector<DecisionColumn> result;
  for (std::size_t k = 0; k < table.size(); ++k)
    if (!table[k].name.empty()) result.push_back(column(table[k].name, rows_->by_column[k]));
  return result;
}

}  // namespace talisman::sequences
