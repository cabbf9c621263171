// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The numbers of a row, named once for CSV and JSON.
///
///   constexpr NamedValue<Ship> kQuantities[] = {{"mass_t", [](const Ship& s) { return s.mass_t; }}, …};
///
///   "ship" + csv_names(kQuantities)                      ship,mass_t,…
///   quoted(ship.name) + csv_cells(kQuantities, ship)     "Enterprise",1.5,…
///
/// What is not finite is an empty cell, and null.

#include <string>

#include <nlohmann/json.hpp>

#include "sequences/files/number_text.h"

namespace talisman::sequences {

template <typename Row>
struct NamedValue {
  const char* name;
  double (*value)(const Row&);
};

/// A comma before each.
template <typename Quantities>
std::string csv_names(const Quantities& quantities) {
  std::string csv;
  for (const auto& quantity : quantities) csv += std::string(",") + quantity.name;
  return csv;
}

/// A comma before each; nine significant digits.
template <typename Quantities, typename Row>
std::string csv_cells(const Quantities& quantities, const Row& row) {
  std::string csv;
  for (const auto& quantity : quantities) csv += "," + exact(quantity.value(row));
  return csv;
}

template <typename Quantities, typename Row>
void put(nlohmann::ordered_json& json, const Quantities& quantities, const Row& row) {
  for (const auto& quantity : quantities) json[quantity.name] = number_or_null(quantity.value(row));
}

/// A CSV cell that may hold commas and quotes.
inline std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, "\"");
  return "\"" + text + "\"";
}

}  // namespace talisman::sequences
