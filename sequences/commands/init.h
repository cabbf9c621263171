// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman init`: a sequence file to begin with, made from a model (content/starter/starter.h), on standard output.

#include <iosfwd>
#include <string>

#include "sequences/commands/options.h"

namespace talisman::sequences {

struct InitOptions {
  std::string model;  ///< path
  ContentWords content;
};

/// Throws InputError.
int run_init(const InitOptions& options, std::ostream& out);

}  // namespace talisman::sequences
