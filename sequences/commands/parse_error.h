// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One line for a command line that cannot be read: what is wrong with it, and what was probably meant.

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace talisman::sequences {

/// `app` has thrown `error` from parse().
///
///   'rendr' is no command; did you mean 'render'?
///   'paint' is no command; must be one of render, plan, …
///   '--versoin' is no option; did you mean '--version'?
///   '--sise' is no option of plan; did you mean '--size'?
std::string explained(const CLI::App& app, const CLI::ParseError& error);

struct UnknownOption {
  std::string written;  ///< "--sise", without what it is set to
  std::string nearest;  ///< "--size"; empty if none is near
};

/// The first option among `arguments`, which the command did not take.
std::optional<UnknownOption> unknown_option(const CLI::App& command,
                                            const std::vector<std::string>& arguments);

}  // namespace talisman::sequences
