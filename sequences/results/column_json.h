// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows of a column table (columns.h) as JSON, and back.

#include <nlohmann/json.hpp>

#include "sequences/results/columns.h"

namespace talisman::sequences {

/// Absent becomes null as well: callers leave those out.
nlohmann::ordered_json json_of(const Value& value);
/// Throws std::invalid_argument for arrays and objects.
Value value_from(const nlohmann::ordered_json& json);

/// A table made ready to write and read many rows. Keeps a reference.
template <typename Row>
class RowJson {
 public:
  explicit RowJson(const ColumnTable<Row>& table) : table_(table) {
    for (const auto& group : table.groups) groups_.emplace_back("/" + group.path);
    for (const auto& column : table.columns)
      places_.push_back({Pointer("/" + column.path), group_of(column)});
  }

  nlohmann::ordered_json write(const Row& row) const {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    if (!table_.schema.empty()) json["schema"] = table_.schema;
    std::vector<bool> has;
    for (const auto& group : table_.groups) has.push_back(group.has(row));
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const int group = places_[k].group;
      if (group >= 0 && !has[group]) {
        if (table_.groups[group].null_if_absent) json[groups_[group]] = nullptr;
        continue;
      }
      const Value value = table_.columns[k].get(row);
      if (!std::holds_alternative<Absent>(value)) json[places_[k].pointer] = json_of(value);
    }
    return json;
  }

  /// Sets what can be set; null leaves a member as it is. Throws nlohmann::json::exception or
  /// std::invalid_argument if an entry is missing or of another kind.
  void read(const nlohmann::ordered_json& json, Row& row) const {
    std::vector<bool> has;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const bool must_be = table_.groups[g].null_if_absent;
      has.push_back(must_be ? !json.at(groups_[g]).is_null() : json.contains(groups_[g]));
      if (has.back() && table_.groups[g].make) table_.groups[g].make(row);
    }
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (!table_.columns[k].set || (places_[k].group >= 0 && !has[places_[k].group])) continue;
      const auto& entry = json.at(places_[k].pointer);
      if (!entry.is_null()) table_.columns[k].set(row, value_from(entry));
    }
  }

 private:
  using Pointer = nlohmann::ordered_json::json_pointer;
  struct Place {
    Pointer pointer;
    int group;  ///< -1: none
  };

  int group_of(const ColumnInfo& column) const {
    for (std::size_t g = 0; g < table_.groups.size(); ++g)
      if (column.path.rfind(table_.groups[g].path + "/", 0) == 0) return static_cast<int>(g);
    return -1;
  }

  const ColumnTable<Row>& table_;
  std::vector<Pointer> groups_;
  std::vector<Place> places_;
};

}  // namespace talisman::sequences
