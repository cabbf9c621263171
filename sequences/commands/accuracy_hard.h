// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --hard`: does every stage get right what is hard? Needs no sequence. The files are those of
/// experiments/hard/report.h.

#include <iosfwd>
#include <string>

#include "sequences/files/progress.h"

namespace talisman::sequences {

/// Measures all cases, writes into the folder `dir` and prints. kFailed if a rule is broken: the table and the files are there
/// all the same. Throws OutputError.
int run_hard_accuracy(const std::string& dir, ProgressKind progress, std::ostream& out);

}  // namespace talisman::sequences
