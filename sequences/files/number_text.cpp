// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/number_text.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> text;  // the largest double has 309 digits before the point
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string percent_of(double part, double whole) { return whole > 0 ? fixed(100 * part / whole, 1) : "-"; }

std::string number_text(const char* pattern, double value) {
  if (!std::isfinite(value)) return "";
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), pattern, value);
  return text.data();
}

std::string exact(double value) { return number_text("%.9g", value); }

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace talisman::sequences
