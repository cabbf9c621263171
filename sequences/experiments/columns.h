// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The numbers of a row, named once for CSV and JSON.
///
///   constexpr Column<Ship> kColumns[] = {{"mass_t", [](const Ship& s) { return s.mass_t; }}, …};
///
///   "ship" + csv_names(kColumns)                      ship,mass_t,…
///   quoted(ship.name) + csv_cells(kColumns, ship)     "Enterprise",1.5,…
///
/// What is not finite is an empty cell, and null.

#include <string>

#include <nlohmann/json.hpp>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

template <typename Row>
struct Column {
  const char* name;
  double (*value)(const Row&);
};

/// A comma before each.
template <typename Columns>
std::string csv_names(const Columns& columns) {
  std::string csv;
  for (const auto& column : columns) csv += std::string(",") + column.name;
  return csv;
}

/// A comma before each; nine significant digits.
template <typename Columns, typename Row>
std::string csv_cells(const Columns& columns, const Row& row) {
  std::string csv;
  for (const auto& column : columns) csv += "," + exact(column.value(row));
  return csv;
}

template <typename Columns, typename Row>
void put(nlohmann::ordered_json& json, const Columns& columns, const Row& row) {
  for (const auto& column : columns) json[column.name] = number_or_null(column.value(row));
}

/// A CSV cell that may hold commas and quotes.
inline std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, "\"");
  return "\"" + text + "\"";
}

}  // namespace talisman::sequences
