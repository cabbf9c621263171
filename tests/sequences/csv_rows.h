// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The tables of an experiment as its tests read them.

#include <sstream>
#include <string>
#include <vector>

namespace talisman::tests {

using CsvRows = std::vector<std::vector<std::string>>;

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

/// The first row is the header. Quotes are not looked at.
inline CsvRows rows_of(const std::string& csv) {
  CsvRows rows;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) rows.push_back(cells_of(line));
  return rows;
}

/// What does not depend on the clock.
inline CsvRows without_times(const std::string& csv) {
  CsvRows rows = rows_of(csv);
  for (std::size_t k = rows[0].size(); k-- > 0;)
    if (rows[0][k].rfind("wall_", 0) == 0)
      for (auto& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(k));
  return rows;
}

}  // namespace talisman::tests
