// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Of what kind is one reason (reason_tally.h)?

#include <string>

#include "sequences/results/reason_tally.h"

namespace talisman::sequences {

/// `times` is 1.
ReasonKind kind_of_reason(const std::string& reason);

}  // namespace talisman::sequences
