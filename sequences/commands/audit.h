// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman audit SEQUENCE|MODEL`: a run whose fiducials are set against its pictures (results/audit.h). It
/// decides and draws as `render` does and writes the same results, but no pictures of frames: the sheets of
/// DIR/audit are its pictures.

#include <atomic>
#include <iosfwd>

#include "sequences/commands/options.h"

namespace talisman::sequences {

/// Returns as run_sequence does; marks change nothing in that.
int run_audit(CommandLine line, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
