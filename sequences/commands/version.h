// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which build is this?

#include <string>

namespace talisman::sequences {

/// What `talisman --version` prints, five lines: version; commit ("unknown" where it was not built from a git
/// checkout of its own, "-dirty" after it where files differ from it); effects built; instruction set that
/// the inner loops run with on this machine, by its name in Highway.
std::string version_text();

/// $TALISMAN_SIMD, where it is set, is the instruction set that the inner loops run with, by its name in Highway ("SSE2"): to
/// compare what may not differ. Throws InputError for one that this machine or this build does not have. Before anything is drawn.
void use_asked_instruction_set();

}  // namespace talisman::sequences
