// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers as they stand in tables, CSV and JSON. What is not finite is "-" to a reader, an empty cell in CSV
/// and null in JSON.

#include <cstdio>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace talisman::sequences {

/// `value` with `digits` after the point; "-" where it is not finite.
std::string fixed(double value, int digits);

/// The share of `part` in `whole` in per cent with one digit after the point, without the sign; "-" where there
/// is no whole (≤ 0).
std::string percent_of(double part, double whole);

/// As printf prints it with `pattern`, which takes one double; empty where it is not finite.
std::string number_text(const char* pattern, double value);

/// As printf prints it; what is longer than 600 bytes is cut off.
std::string formatted(const char* pattern, auto... values) {
  char text[600];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Nine significant digits, for CSV; empty where the value is not finite.
std::string exact(double value);

/// For JSON, which has no infinity.
nlohmann::ordered_json number_or_null(double value);

}  // namespace talisman::sequences
