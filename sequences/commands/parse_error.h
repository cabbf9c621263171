// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One line for a command line that cannot be read: what is wrong with it, and what was probably meant.

#include <string>

#include <CLI/CLI.hpp>

namespace talisman::sequences {

/// `app` has thrown `error` from parse().
///
///   'rendr' is no command; did you mean 'render'?
///   'paint' is no command; must be one of render, plan, …
///   '--versoin' is no option; did you mean '--version'?
///   The following argument was not expected: --sise=64x64; did you mean '--size'?
std::string explained(const CLI::App& app, const CLI::ParseError& error);

}  // namespace talisman::sequences
