// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

namespace talisman::sequences {

template <typename T>
struct NumberOf {
  using type = T;
};
template <typename T>
struct NumberOf<std::optional<T>> {
  using type = T;
};

/// What is wrong with the text of a number, or empty: every number is finite, whole ones fit their type.
template <typename Number>
std::string number_defect(const std::string& text) {
  if constexpr (std::is_floating_point_v<Number>) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = !text.empty() && *end == '\0';
    if (!is_number || !std::isfinite(value)) return "'" + text + "', rule: a finite number";
  } else {
    Number value{};
    const char* first = text.c_str() + (text.rfind('+', 0) == 0 ? 1 : 0);
    const auto [end, error] = std::from_chars(first, text.c_str() + text.size(), value);
    if (error == std::errc::result_out_of_range) return "'" + text + "', rule: a number that can be held";
    if (error != std::errc() || *end != '\0') return "'" + text + "', rule: a whole number";
  }
  return {};
}

/// The options of a command that stand under one heading of its help.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, std::string heading) : command_(command), heading_(std::move(heading)) {}

  /// `standard`: what holds without the option, as it would be typed; the help shows it behind "=".
  template <typename T>
  OptionGroup& option(const char* name, T& value, const std::string& meaning,
                      const std::string& standard = "") {
    CLI::Option* option = command_.add_option(name, value, meaning)->group(heading_);
    if (!standard.empty()) option->default_str(standard);
    using Number = typename NumberOf<T>::type;
    if constexpr (std::is_same_v<T, std::string>)
      option->check([](const std::string& text) {
        return text.empty() ? std::string("'', rule: not empty") : std::string();
      });
    if constexpr (std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>)
      option->check([](const std::string& text) { return number_defect<Number>(text); });
    return *this;
  }
  OptionGroup& flag(const char* name, bool& value, const std::string& meaning) {
    command_.add_flag(name, value, meaning)->group(heading_);
    return *this;
  }

 private:
  CLI::App& command_;
  std::string heading_;
};

}  // namespace talisman::sequences
