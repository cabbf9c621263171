// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman render` and `talisman plan`: a run from its command line to the folder that it leaves.

#include <atomic>
#include <iosfwd>

#include "sequences/commands/options.h"

namespace talisman::sequences {

/// Returns success, or kPartialResult when `stop` became true before the last frame. Throws InputError and
/// OutputError.
int run_sequence(const CommandLine& line, bool plan_only, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
