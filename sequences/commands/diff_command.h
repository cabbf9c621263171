// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman diff A B`: image error of two frames, or of two folders frame by frame, as a table or as one JSON
/// document (schema talisman.diff/1). Of two result folders also settings, costs, rates and decisions
/// (results/run_difference.h), with or without pictures.

#include <iosfwd>

#include "sequences/pictures/diff.h"

namespace talisman::sequences {

/// Prints the report; returns 0, or 3 when frames were missing, and then says so on stderr.
int run_diff(const DiffOptions& options, std::ostream& out);

}  // namespace talisman::sequences
