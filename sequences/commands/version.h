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
/// $TALISMAN_ORDER, where it is set, is the number of the order in which chunks and bands begin (chunker/job_order.h): 0 is that of the
/// index. Throws InputError for what is no whole number below 2³². Before anything is drawn.
void use_asked_job_order();

}  // namespace talisman::sequences
