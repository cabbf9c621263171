// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <CLI/CLI.hpp>

namespace talisman::sequences {

/// The options of a command that stand under one heading of its help.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, std::string heading) : command_(command), heading_(std::move(heading)) {}

  template <typename T>
  OptionGroup& option(const char* name, T& value, const std::string& meaning) {
    command_.add_option(name, value, meaning)->group(heading_);
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
